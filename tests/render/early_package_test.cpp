// Early packages, which show an edit of a pack as a draft until the whole package is made.
#include "base/files.h"
#include "emit/compile.h"
#include "materials/declarations.h"
#include "render/edited_scene.h"
#include "render/pixel_test.h"
#include "render/replacement.h"
#include "renderer/renderer.h"
#include "resolve/resolve.h"
#include "support/shared_modules.h"
#include "support/temporary_folder.h"

#include <glint/session/scene_view.h>
#include <glint/session/session.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <sys/resource.h>
#include <utility>
#include <vector>

namespace {

using namespace glint;
using namespace glint::testing;

constexpr std::uint32_t kPainted = 1;  // the mesh whose material has the pack's feature

constexpr const char* kPaintDeclaration = R"({
    "name": "paint", "object": "extras", "stage": "surface", "glsl": { "surface": "paint.glsl" }, "draft": true,
    "parameters": [{ "name": "paintAmount", "at": "paint", "type": "float", "default": 0, "range": [0, 1] }],
    "neutral": [{ "when": "paintAmount == 0", "because": "there is no paint" }]
})";

// Paints in a shade of green, by a function of a file of its own.
std::string paintGlsl(const std::filesystem::path& folder) {
    return "#include \"hit/surface_values.glsl\"\n"
           "#include \"" +
           (folder / "shade_of_paint.glsl").generic_string() +
           "\"\n\n"
           "void paintSurface(Hit hit, Features features, inout SurfaceValues values) {\n"
           "    values.color.rgb = mix(values.color.rgb, shadeOfPaint(), GLINT_MATERIAL_PAINT_AMOUNT(hit));\n"
           "}\n";
}

// The model of the pack with another shade. `folder` holds the pack.
const materials::MaterialModel* paintModel(const std::filesystem::path& folder, const std::string& shade) {
    const std::string shadeGlsl = "vec3 shadeOfPaint() {\n    return vec3(0.1, " + shade + ", 0.2);\n}\n";
    EXPECT_TRUE(base::writeFile(folder / "paint.json", std::string(kPaintDeclaration)));
    EXPECT_TRUE(base::writeFile(folder / "paint.glsl", paintGlsl(folder)));
    EXPECT_TRUE(base::writeFile(folder / "shade_of_paint.glsl", shadeGlsl));
    const Result<const materials::MaterialModel*> model =
        materials::loadMaterialModel(std::vector<std::string>{folder.string()});
    EXPECT_TRUE(model) << toString(model.error());
    return model ? *model : nullptr;
}

materials::Material glossy(const materials::MaterialModel& model, gltf::Float3 color) {
    materials::Material material(model);
    material["baseColorFactor"] = {color[0], color[1], color[2], 1.0F};
    material["metallicFactor"] = 0.0F;
    material["roughnessFactor"] = 0.5F;
    return material;
}

// A mirror below two walls, of which one is painted and one is not.
gltf::Scene paintedRoom(const materials::MaterialModel& model) {
    gltf::Scene scene = emptyScene();
    addCamera(scene);
    materials::Material mirror = glossy(model, {1, 1, 1});
    mirror["metallicFactor"] = 1.0F;
    mirror["roughnessFactor"] = 0.0F;
    materials::Material painted = glossy(model, kRed);
    painted["paintAmount"] = 1.0F;
    int mesh = addMesh(scene, makeQuad(addMaterial(scene, mirror), {-4, -1, 0}, {8, 0, 0}, {0, 0, -8}));
    addInstance(scene, mesh);
    mesh = addMesh(scene, makeQuad(addMaterial(scene, painted), {-4, -0.9F, -5}, {4, 0, 0}, {0, 4, 0}));
    addInstance(scene, mesh);
    mesh = addMesh(scene,
                   makeQuad(addMaterial(scene, glossy(model, kBlue)), {0, -0.9F, -5}, {4, 0, 0}, {0, 4, 0}));
    addInstance(scene, mesh);
    addDirectionalLight(scene, {0.0F, -0.6F, -0.8F}, 2.0F);
    return scene;
}

// A fallback's draft is the reference of what early packages show.
compiler::CompileSettings paintedSettings(bool fallback = true) {
    compiler::CompileSettings settings = roomSettings(package::kStrategyVisibility, fallback);
    settings.tracers = tracerOfDevice();
    settings.emitHeader = false;
    return settings;
}

// One version of the pack, and the packages that a watch writes after the edit that led to it.
struct Version {
    const materials::MaterialModel* model = nullptr;
    std::unique_ptr<gltf::Scene> scene;
    compiler::CompiledPackage compiled;
    std::shared_ptr<const Package> early;
    std::shared_ptr<const Package> whole;
};

std::shared_ptr<const Package> load(const compiler::CompiledPackage& compiled) {
    const auto package = session::loadPackage(compiled);
    EXPECT_TRUE(package) << toString(package.error());
    return package ? *package : nullptr;
}

// Compiles a version after `before`, which may be null.
Version makeVersion(const materials::MaterialModel* model, const Version* before, bool fallback = true) {
    Version version;
    version.model = model;
    version.scene = std::make_unique<gltf::Scene>(paintedRoom(*model));
    std::optional<compiler::EarlyShowing> showing;
    if (before != nullptr) {
        showing = compiler::EarlyShowing{&before->compiled,
                                         [&](const compiler::CompiledPackage& early) {
                                             version.early = load(early);
                                             return true;
                                         },
                                         {}};
    }
    Result<compiler::CompiledPackage> compiled =
        compilePackage(*compiler::resolve(std::span(version.scene.get(), 1), paintedSettings(fallback)),
                       &sharedModules(), nullptr, showing ? &*showing : nullptr);
    EXPECT_TRUE(compiled) << toString(compiled.error());
    if (compiled) {
        version.compiled = std::move(*compiled);
        version.whole = load(version.compiled);
    }
    return version;
}

class EarlyPackage : public ReplacementTest {
protected:
    static void SetUpTestSuite() {
        folder_ = new glint::test::TemporaryFolder();
        versions_ = new std::vector<Version>();
        for (const char* const shade : {"0.2", "0.9", "0.6"}) {
            const materials::MaterialModel* const model = paintModel(folder_->path(), shade);
            ASSERT_NE(model, nullptr);
            versions_->push_back(makeVersion(model, versions_->empty() ? nullptr : &versions_->back()));
        }
    }
    static void TearDownTestSuite() {
        delete versions_;
        delete folder_;
    }
    void SetUp() override {
        ASSERT_EQ(versions_->size(), 3U);
        for (const Version& one : *versions_) {
            ASSERT_NE(one.whole, nullptr);
        }
        ASSERT_NE(version(1).early, nullptr);
        ASSERT_NE(version(2).early, nullptr);
        setup_ = defaultSetup(*version(0).scene, 24, 24);
        options_ = optionsOf(package::kStrategyVisibility, tracerOfDevice());
    }
    static const Version& version(std::size_t number) {
        return (*versions_)[number];
    }

    static std::unique_ptr<GpuScene> upload(const Version& version) {
        return uploadScene(*version.whole, *version.scene);
    }
    // Makes the test's renderer anew, with all its pipelines. It shows a package of the first version's
    // scene. Returns null if that fails.
    Renderer* start(const Package& package, const RendererOptions& options) {
        renderer_.reset();
        scene_ = upload(version(0));
        renderer_ = scene_ ? makeRenderer(package, *scene_, options) : nullptr;
        if (renderer_) {
            renderer_->waitForPipelines();
        }
        return renderer_.get();
    }
    // Returns the picture of a scene and a renderer of its own, or of its draft.
    LinearImage fresh(const Version& of, bool draft = false) const {
        const std::unique_ptr<GpuScene> scene = upload(of);
        RendererOptions options = options_;
        options.backgroundPipelines = draft;
        const std::unique_ptr<Renderer> renderer = scene ? makeRenderer(*of.whole, *scene, options) : nullptr;
        if (!renderer) {
            return {};
        }
        if (draft) {
            renderer->state().pipelines.adoptedAtOnce = 0;
        }
        return draw(*renderer);
    }
    // Returns `rest` with the pixels that see the painted wall from `painted`.
    static LinearImage compose(Renderer& renderer, const LinearImage& rest, const LinearImage& painted) {
        LinearImage image = rest;
        std::size_t count = 0;
        for (std::uint32_t y = 0; y < image.height; ++y) {
            for (std::uint32_t x = 0; x < image.width; ++x) {
                const auto place = renderer.readPlace(x, y);
                EXPECT_TRUE(place);
                if (place && *place && (*place)->mesh == kPainted) {
                    const std::size_t pixel = std::size_t{y} * image.width + x;
                    image.pixels[pixel] = painted.pixels[pixel];
                    ++count;
                }
            }
        }
        EXPECT_GT(count, 20U);
        EXPECT_LT(count, image.pixels.size() / 2);
        return image;
    }

    static inline glint::test::TemporaryFolder* folder_ = nullptr;
    static inline std::vector<Version>* versions_ = nullptr;
    RendererOptions options_;
    std::unique_ptr<GpuScene> scene_;
    std::unique_ptr<Renderer> renderer_;
};

TEST_F(EarlyPackage, HasOneModuleMoreAndTheTablesOfThePackageBefore) {
    const Package& before = *version(0).whole;
    const Package& early = *version(1).early;
    EXPECT_TRUE(early.shape().early);
    EXPECT_FALSE(version(1).whole->shape().early);
    for (const package::ModuleKey& key : package::requiredModules(before.shape())) {
        const auto words = before.spirv(key);
        const auto same = early.spirv(key);
        EXPECT_TRUE(std::equal(words.begin(), words.end(), same.begin(), same.end()))
            << package::roleName(key.role);
    }
    EXPECT_TRUE(before.spirv({package::ModuleRole::LightingEdit}).empty());
    EXPECT_FALSE(early.spirv({package::ModuleRole::LightingEdit}).empty());
}

// The states of one edit, with pipelines that are made in the call and with threads that make them.
TEST_F(EarlyPackage, TheEditIsADraftUntilTheWholePackageIsInUse) {
    const LinearImage old = fresh(version(0));
    const LinearImage draft = fresh(version(1), true);
    const LinearImage wanted = fresh(version(1));
    ASSERT_TRUE(differ(old, wanted));
    for (const bool background : {false, true}) {
        RendererOptions options = options_;
        options.backgroundPipelines = background;
        Renderer* const renderer = start(*version(0).whole, options);
        ASSERT_NE(renderer, nullptr);
        expectSameImage(draw(*renderer), old, "before");
        EXPECT_FALSE(renderer->replacementProgress().early);

        const Result<Renderer::Replacement> replaced = renderer->replacePackage(version(1).early);
        ASSERT_TRUE(replaced) << toString(replaced.error());
        EXPECT_EQ(replaced->pipelinesMade, 1U);
        EXPECT_EQ(replaced->buffersMade, 0U);
        renderer->waitForPipelines();
        const LinearImage shown = draw(*renderer);
        EXPECT_TRUE(renderer->replacementProgress().early);
        EXPECT_EQ(renderer->replacementProgress().inUse, 1U);
        expectSameImage(shown, compose(*renderer, old, draft), "the early package");
        ASSERT_TRUE(differ(shown, old));

        renderer->state().pipelines.adoptedAtOnce = 0;
        ASSERT_TRUE(renderer->replacePackage(version(1).whole));
        renderer->waitForPipelines();
        if (background) {
            expectSameImage(draw(*renderer), shown, "while pipelines are made");
            renderer->state().pipelines.adoptedAtOnce = std::numeric_limits<std::size_t>::max();
        }
        expectSameImage(draw(*renderer), wanted, "the whole package");
        EXPECT_FALSE(renderer->replacementProgress().early);
        EXPECT_EQ(renderer->replacementProgress().inUse, 2U);
        expectNoValidationMessages();
    }
}

// Without a fallback no materials come later. So the module has the features of the edited surfaces, and
// takes for granted what all of them have.
TEST_F(EarlyPackage, HasLessCodeWithoutAFallback) {
    const Version before = makeVersion(version(0).model, nullptr, false);
    const Version after = makeVersion(version(1).model, &before, false);
    ASSERT_NE(after.early, nullptr);
    const package::ModuleKey edit{package::ModuleRole::LightingEdit};
    EXPECT_LT(after.early->spirv(edit).size(), version(1).early->spirv(edit).size());
    const std::unique_ptr<GpuScene> scene = upload(before);
    const std::unique_ptr<Renderer> renderer = makeRenderer(*after.early, *scene, options_);
    ASSERT_NE(renderer, nullptr);
    const LinearImage shown = draw(*renderer);
    expectSameImage(shown, compose(*renderer, fresh(version(0)), fresh(version(1), true)), "the draft");
    expectNoValidationMessages();
}

// A program that starts while an edit is compiled may find an early package.
TEST_F(EarlyPackage, ARendererMayBeginWithOne) {
    Renderer* const renderer = start(*version(1).early, options_);
    ASSERT_NE(renderer, nullptr);
    EXPECT_TRUE(renderer->replacementProgress().early);
    const LinearImage shown = draw(*renderer);
    expectSameImage(shown, compose(*renderer, fresh(version(0)), fresh(version(1), true)),
                    "the early package");
    ASSERT_TRUE(renderer->replacePackage(version(1).whole));
    expectSameImage(draw(*renderer), fresh(version(1)), "the whole package");
    expectNoValidationMessages();
}

// A second edit arrives while the pipelines of the first one's whole package are made.
TEST_F(EarlyPackage, ASecondEditTakesThePlaceOfTheFirst) {
    RendererOptions options = options_;
    options.backgroundPipelines = true;
    Renderer* const renderer = start(*version(0).whole, options);
    ASSERT_NE(renderer, nullptr);
    ASSERT_TRUE(renderer->replacePackage(version(1).early));
    renderer->waitForPipelines();
    const LinearImage first = draw(*renderer);
    ASSERT_TRUE(renderer->replacementProgress().early);
    renderer->state().pipelines.adoptedAtOnce = 0;
    ASSERT_TRUE(renderer->replacePackage(version(1).whole));
    ASSERT_TRUE(renderer->replacePackage(version(2).early));
    renderer->waitForPipelines();
    expectSameImage(draw(*renderer), first, "while pipelines are made");
    renderer->state().pipelines.adoptedAtOnce = std::numeric_limits<std::size_t>::max();
    const LinearImage second = draw(*renderer);
    EXPECT_TRUE(renderer->replacementProgress().early);
    renderer->state().pipelines.adoptedAtOnce = std::numeric_limits<std::size_t>::max();
    // Reflections show the whole of the first edit.
    expectSameImage(second, compose(*renderer, fresh(version(1)), fresh(version(2), true)),
                    "the second edit");
    ASSERT_TRUE(renderer->replacePackage(version(2).whole));
    renderer->waitForPipelines();
    expectSameImage(draw(*renderer), fresh(version(2)), "the whole package");
    EXPECT_FALSE(renderer->replacementProgress().early);
    expectNoValidationMessages();
}

// Without drafts an early package looks like the package before.
TEST_F(EarlyPackage, IsNotShownByARendererWithoutDrafts) {
    RendererOptions options = options_;
    options.draft = false;
    Renderer* const renderer = start(*version(0).whole, options);
    ASSERT_NE(renderer, nullptr);
    const LinearImage old = draw(*renderer);
    const Result<Renderer::Replacement> replaced = renderer->replacePackage(version(1).early);
    ASSERT_TRUE(replaced);
    EXPECT_EQ(replaced->pipelinesMade, 0U);
    expectSameImage(draw(*renderer), old, "the early package");
    EXPECT_FALSE(renderer->replacementProgress().early);
    expectNoValidationMessages();
}

// What early packages can't show.
TEST_F(EarlyPackage, OtherEditsTakeTheOrdinaryWay) {
    const materials::MaterialModel& before = *version(0).model;
    const materials::FeatureMask paint = before.mask("paint");
    ASSERT_NE(paint, 0U);
    EXPECT_EQ(compiler::editedFeatures(before, *version(1).model), paint);
    EXPECT_EQ(compiler::editedFeatures(before, before), 0U);
    materials::MaterialModel other = before;
    other.sources.push_back({"more.glsl", ""});
    EXPECT_EQ(compiler::editedFeatures(before, other), 0U) << "a file more";
    materials::MaterialModel unread = other;
    unread.sources.back().text = "// nobody includes this";
    EXPECT_EQ(compiler::editedFeatures(other, unread), 0U) << "a file that no feature reads";
    materials::MaterialModel layer = *version(1).model;
    const auto code = std::ranges::find(layer.code, "paint", &materials::FeatureCode::name);
    ASSERT_NE(code, layer.code.end());
    code->bsdf = std::exchange(code->surface, "");
    EXPECT_EQ(compiler::editedFeatures(before, layer), 0U) << "a stage that drafts lack";

    // Another colour is in the tables, so the early package would show it nowhere.
    gltf::Scene repainted = paintedRoom(*version(1).model);
    repainted.materials[kPainted]["baseColorFactor"] = {0.0F, 1.0F, 1.0F, 1.0F};
    bool shown = false;
    const compiler::EarlyShowing showing{
        &version(0).compiled, [&](const compiler::CompiledPackage&) { return shown = true; }, {}};
    ASSERT_TRUE(compilePackage(*compiler::resolve(std::span(&repainted, 1), paintedSettings()),
                               &sharedModules(), nullptr, &showing));
    EXPECT_FALSE(shown);
}

// A compilation that nobody needs any more ends. Its threads ask for that, and leave the cores to who draws.
TEST_F(EarlyPackage, AnOutdatedCompilationEnds) {
    const materials::MaterialModel* const model = paintModel(folder_->path(), "0.31415");
    ASSERT_NE(model, nullptr);
    const gltf::Scene scene = paintedRoom(*model);
    constexpr int kMostNice = 19;
    const int own = getpriority(PRIO_PROCESS, 0);
    std::atomic<int> asked{own};
    for (const bool published : {true, false}) {
        const compiler::EarlyShowing showing{&version(2).compiled,
                                             [&](const compiler::CompiledPackage&) { return published; },
                                             [&] {
                                                 asked = getpriority(PRIO_PROCESS, 0);
                                                 return true;
                                             }};
        const Result<compiler::CompiledPackage> compiled =
            compilePackage(*compiler::resolve(std::span(&scene, 1), paintedSettings()),
                           published ? nullptr : &sharedModules(), nullptr, &showing);
        EXPECT_EQ(compiled.ok(), !published);
        if (!compiled) {
            EXPECT_EQ(compiled.error().id, "outdated");
            EXPECT_EQ(asked, std::min(own + 5, kMostNice));
            EXPECT_EQ(getpriority(PRIO_PROCESS, 0), own);
        }
    }
}

}  // namespace
