// Random scenes: no number is wrong, no picture is empty in silence, and neither the strategy, nor how the
// file writes the scene, nor where the scene is, changes the picture. By day there are 200 scenes, at night
// 10,000. GLINT_RANDOM_SCENE=SEED checks one alone, with all strategies; GLINT_RANDOM_FIRST=SEED starts
// elsewhere.
#include "gltf/import.h"
#include "render/edited_scene.h"
#include "render/random_scene.h"
#include "support/must.h"
#include "support/nightly.h"
#include "unit/gltf/gltf_builder.h"

#include <glint/internal/package_modules.h>
#include <glint/session/camera.h>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace {

using namespace glint;
using namespace glint::testing;

constexpr std::uint32_t kSide = 16;  // pixels
// By day one of so many scenes is drawn with all strategies.
constexpr std::uint64_t kAllStrategiesEach = 8;

std::optional<std::uint64_t> numberIn(const char* variable) {
    const char* const text = std::getenv(variable);
    return text == nullptr ? std::nullopt : std::optional<std::uint64_t>(std::strtoull(text, nullptr, 10));
}

struct Picture {
    LinearImage image;
    session::CameraChoice camera;
    bool hasSurface = false;
};

// A package for all random scenes, and renderers that draw one after the other, so that no pipeline is made
// twice.
class Stage {
public:
    Stage() : scene_(read(everyRandomMaterial())) {
        compiler::CompileSettings settings;
        settings.strategies = package::allStrategies();
        settings.tracers = sharedContext().handles().tracers;
        settings.plan.merge = compiler::MergePolicy::Family;
        settings.plan.keys.alpha = package::AlphaPolicy::Tested;
        settings.effects = {false, compiler::builtinEffects({"shadow", "reflection", "refraction"})};
        settings.emissiveLights = compiler::EmissiveLights::Off;
        loaded_ = std::make_unique<LoadedScene>(scene_, settings);
        layout_ = session::recordLayoutOf(package(), scene_.materials.front().model());
        data_ = session::makeSceneView(scene_);
        SceneView view = data_.view();
        view.editable = true;
        view.vertices = SceneView::VertexForm::Full;
        gpuScene_ = uploadScene(package(), view);
        textures_ = session::uploadedTextures(editor(), package().scene(0), scene_);
        for (std::uint32_t i = 0; i < data_.instances.size(); ++i) {
            instances_.push_back(editor().instance(i));
            meshes_.push_back(editor().mesh(data_.instances[i].mesh));
        }
        lights_.push_back(editor().light(0));
        frames_ = std::make_unique<TwoFrames>(sharedContext());
        for (const package::Strategy strategy : package::strategies()) {
            RendererOptions options;
            options.strategy = strategy;
            options.width = options.height = kSide;
            renderers_.push_back(makeRenderer(package(), *gpuScene_, options));
        }
    }

    // Reads a file as the command does. The scene is empty if that fails.
    static gltf::Scene read(const std::string& file) {
        gltf::ImportOptions options;
        options.decodeImages = true;
        return must(test::importText(file, options));
    }

    // Puts a scene into the place of the last one, and draws it with the first `count` strategies. All
    // pictures must be the same; the first is returned. Fails the test where nothing is seen in silence.
    // `given` takes the place of the scene's own camera.
    Picture draw(const std::string& file, std::size_t count,
                 const std::optional<session::CameraChoice>& given = std::nullopt) {
        const gltf::Scene scene = read(file);
        if (scene.materials.size() != scene_.materials.size()) {
            return {};
        }
        const session::SceneViewData data = session::makeSceneView(scene);
        const session::CameraChoice camera =
            must(given ? Result<session::CameraChoice>(*given) : session::chooseCamera(scene, data, "", 1.0));
        clear();
        fill(scene, data);
        submit();
        FrameOptions frame;
        frame.camera = camera.view;
        // The editable scene counts its places from 0, and is given those of `data`, which have an origin.
        for (std::size_t i = 0; i < data.origin.size(); ++i) {
            frame.camera.position[i] -= data.origin[i];
        }
        Picture first;
        first.camera = camera;
        for (std::size_t i = 0; i < count; ++i) {
            LinearImage image = must(renderers_[i]->render(frame));
            const std::string name(package::nameOf(package::strategies()[i]));
            if (i > 0) {
                expectSameImage(image, first.image, name);
                continue;
            }
            first.image = std::move(image);
            expectFinite(first.image);
            const Result<std::vector<std::uint8_t>> surfaces = renderers_[i]->readSurfaces();
            EXPECT_TRUE(surfaces);
            first.hasSurface = surfaces && std::ranges::find(*surfaces, 1) != surfaces->end();
        }
        expectNotSilent(scene, data, camera, first.hasSurface);
        return first;
    }

private:
    const Package& package() const {
        return loaded_->package();
    }
    SceneEditor& editor() {
        return *gpuScene_->editor();
    }
    static void expect(const Status& status) {
        EXPECT_TRUE(status) << (status ? "" : toString(status.error()));
    }

    void clear() {
        for (const InstanceHandle instance : instances_) {
            expect(editor().removeInstance(instance));
        }
        for (const MeshHandle mesh : meshes_) {
            expect(editor().removeMesh(mesh));
        }
        for (const LightHandle light : lights_) {
            expect(editor().removeLight(light));
        }
        instances_.clear();
        meshes_.clear();
        lights_.clear();
    }

    void fill(const gltf::Scene& scene, const session::SceneViewData& data) {
        std::vector<MaterialHandle> materials;
        for (std::uint32_t i = 0; i < scene.materials.size(); ++i) {
            materials.push_back(editor().material(i));
            const session::MaterialSourceData source =
                session::makeMaterialSource(package(), layout_, scene, scene.materials[i], textures_);
            const Result<SceneEditor::Report> set = editor().setMaterial(materials[i], source.view());
            EXPECT_TRUE(set) << (set ? "" : toString(set.error()));
        }
        std::vector<MeshHandle> byNumber(scene.meshes.size());
        for (std::size_t i = 0; i < data.primitives.size();) {
            const std::uint32_t mesh = data.primitives[i].mesh;
            std::vector<SceneEditor::EditedPrimitive> primitives;
            for (; i < data.primitives.size() && data.primitives[i].mesh == mesh; ++i) {
                const gltf::Primitive& primitive =
                    scene.meshes[mesh].primitives[data.primitives[i].primitive];
                primitives.push_back(
                    {data.primitives[i], materials[static_cast<std::size_t>(primitive.material)]});
            }
            const SceneEditor::AddedMesh added = must(editor().addMesh(primitives));
            byNumber[mesh] = added.mesh;
            meshes_.push_back(added.mesh);
        }
        for (const InstanceView& view : data.instances) {
            const SceneEditor::AddedInstance added =
                must(editor().addInstance({byNumber[view.mesh], view.objectToWorld, view.visible}));
            instances_.push_back(added.instance);
        }
        std::vector<LightView> lights = data.lights;
        if (lights.empty()) {
            lights.push_back(session::sunLight());
        }
        for (const LightView& light : lights) {
            const LightHandle added = must(editor().addLight(light));
            lights_.push_back(added);
        }
    }

    // Submits the edits.
    void submit() {
        const VkCommandBuffer commands = frames_->begin();
        editor().complete(frames_->completed());
        expect(editor().record(commands, frames_->frame()));
        frames_->submit();
        frames_->drain();
        editor().complete(frames_->completed());
    }

    static void expectFinite(const LinearImage& image) {
        const auto isFinite = [](const std::array<float, 4>& pixel) {
            return std::ranges::all_of(pixel, [](float value) { return std::isfinite(value); });
        };
        EXPECT_TRUE(std::ranges::all_of(image.pixels, isFinite)) << "the picture has NaN or infinity";
    }

    // A picture without a surface has a warning, and one that is sure of it before it is made is right.
    static void expectNotSilent(const gltf::Scene& scene, const session::SceneViewData& data,
                                const session::CameraChoice& camera, bool hasSurface) {
        const bool isEmpty = test::countWarnings(scene, "nothing-drawn") > 0;
        EXPECT_EQ(isEmpty, data.instances.empty());
        const std::optional<Diagnostic> early = session::nothingSeen(scene, data, camera);
        if (hasSurface) {
            EXPECT_FALSE(isEmpty) << "the scene has a surface";
            EXPECT_FALSE(early) << toString(*early);
        } else {
            EXPECT_TRUE(isEmpty || session::nothingSeen(scene, data, camera, true))
                << "nothing is seen, and nothing says so";
        }
    }

    const gltf::Scene scene_;  // of the package
    std::unique_ptr<LoadedScene> loaded_;
    compiler::MaterialLayout layout_;
    session::SceneViewData data_;
    std::unique_ptr<GpuScene> gpuScene_;
    std::vector<session::EditedTextures> textures_;
    std::unique_ptr<TwoFrames> frames_;
    std::vector<std::unique_ptr<Renderer>> renderers_;
    std::vector<MeshHandle> meshes_;
    std::vector<InstanceHandle> instances_;
    std::vector<LightHandle> lights_;
};

// Vertices of the two round differently. So a pixel at an edge may see another surface, in the picture or in
// a reflection, and all others agree.
void expectSimilar(const Picture& picture, const Picture& reference, const std::string& what) {
    constexpr double kMost = 2e-3;
    constexpr std::size_t kMostEdges = kSide * kSide / 16;
    std::size_t edges = 0;
    for (std::size_t i = 0; i < picture.image.pixels.size(); ++i) {
        bool differs = false;
        for (std::size_t channel = 0; channel < 3; ++channel) {
            const double value = reference.image.pixels[i][channel];
            differs = differs || !(std::abs(picture.image.pixels[i][channel] - value) <=
                                   kMost * std::max(1.0, std::abs(value)));
        }
        edges += differs ? 1 : 0;
    }
    EXPECT_LE(edges, kMostEdges) << what << ": pixels differ from those of the tree at the origin";
}

// Keeps the files of a scene that failed.
void keep(const RandomScene& scene, std::uint64_t seed) {
    const std::filesystem::path folder = std::filesystem::path(GLINT_BINARY_DIR) / "random_scenes";
    std::filesystem::create_directories(folder);
    const std::pair<const char*, std::string> files[] = {
        {"tree", scene.file({}, SceneForm::Tree)},
        {"baked", scene.file({}, SceneForm::Baked)},
        {"moved", scene.file(scene.place(), SceneForm::Tree)}};
    for (const auto& [name, text] : files) {
        EXPECT_TRUE(base::writeFile(folder / fmt::format("{}-{}.gltf", seed, name), text));
    }
    ADD_FAILURE() << fmt::format(
        "scene {0} failed; its files are {1}/{0}-*.gltf; alone: GLINT_RANDOM_SCENE={0} test_random_scenes",
        seed, folder.string());
}

TEST(RandomScenes, LookTheSameInEveryWay) {
    Stage stage;
    const std::optional<std::uint64_t> only = numberIn("GLINT_RANDOM_SCENE");
    const std::uint64_t first = only ? *only : numberIn("GLINT_RANDOM_FIRST").value_or(1);
    const std::uint64_t count = only ? 1 : test::nightly() ? 10000 : 200;
    constexpr int kMostFailures = 10;
    int failures = 0;
    std::uint64_t empty = 0;
    for (std::uint64_t seed = first; seed < first + count && failures < kMostFailures; ++seed) {
        const RandomScene scene(seed);
        const ScenePlace& place = scene.place();
        const auto trace = [&](const char* form) {
            return fmt::format("scene {}, {}: scale {:g}, offset {:g} {:g} {:g}", seed, form, place.scale,
                               place.offset[0], place.offset[1], place.offset[2]);
        };
        const int before =
            ::testing::UnitTest::GetInstance()->current_test_info()->result()->total_part_count();
        const bool all = only || test::nightly() || seed % kAllStrategiesEach == 0;
        const std::size_t strategies = all ? package::strategies().size() : 1;
        {
            SCOPED_TRACE(trace("tree"));
            const Picture tree = stage.draw(scene.file({}, SceneForm::Tree), strategies);
            empty += tree.hasSurface ? 0 : 1;
            SCOPED_TRACE(trace("baked or moved"));
            // A camera that frames everything sees boxes, which are smaller there.
            expectSimilar(stage.draw(scene.file({}, SceneForm::Baked), 1, tree.camera), tree, "baked");
            expectSimilar(stage.draw(scene.file(place, SceneForm::Tree), strategies), tree, "moved");
        }
        const int after =
            ::testing::UnitTest::GetInstance()->current_test_info()->result()->total_part_count();
        if (after > before) {
            keep(scene, seed);
            ++failures;
        }
    }
    // Some cameras look away. If most did, the pictures would show little.
    EXPECT_LT(empty, std::max<std::uint64_t>(count / 4, 2));
}

}  // namespace
