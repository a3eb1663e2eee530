// Effects of packs: the effect that docs/effects.md makes, as it is printed.
#include "emit/compile.h"
#include "materials/declaration_files.h"
#include "materials/declarations.h"
#include "render/pixel_test.h"
#include "support/must.h"
#include "support/printed_files.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

namespace {

using namespace glint;
using namespace glint::testing;

constexpr gltf::Float3 kSheet{0.8F, 0.5F, 0.25F};
constexpr float kTransmitted = 0.75F;
constexpr gltf::Float3 kPanel{0.5F, 0.25F, 1.0F};

// A sheet that fills the picture. All that it does with light is to transmit it diffusely. Behind it is a
// panel of known radiance, so large and near that the sheet's far side sees next to nothing else; the panel
// does without light.
gltf::Scene sheetAndPanel(const materials::MaterialModel& model) {
    gltf::Scene scene = sceneWithCamera();
    materials::Material sheet(model);
    sheet["baseColorFactor"] = {0, 0, 0, 1};
    sheet["metallicFactor"] = 0.0F;
    sheet.give("KHR_materials_specular");
    sheet["specularFactor"] = 0.0F;
    sheet.give("KHR_materials_diffuse_transmission");
    sheet["diffuseTransmissionFactor"] = kTransmitted;
    sheet["diffuseTransmissionColorFactor"] = {kSheet[0], kSheet[1], kSheet[2]};
    sheet.doubleSided = true;
    materials::Material panel(model);
    panel.give("KHR_materials_unlit");
    panel["baseColorFactor"] = {kPanel[0], kPanel[1], kPanel[2], 1};
    const int sheetNumber = addMaterial(scene, sheet);
    const int panelNumber = addMaterial(scene, panel);
    addQuad(scene, sheetNumber, {-4, -4, -2}, {8, 0, 0}, {0, 8, 0});
    addQuad(scene, panelNumber, {-4000, -4000, -2.5F}, {8000, 0, 0}, {0, 8000, 0});
    return scene;
}

compiler::CompileSettings settingsWith(const std::vector<std::string>& effects) {
    compiler::CompileSettings settings;
    settings.strategies = package::allStrategies();
    settings.tracers = package::kTracerRayQuery;
    settings.effects = {.ofPacks = effects};
    return settings;
}

// Returns pictures with each strategy; the sky is black.
std::map<package::Strategy, LinearImage> picturesOf(const gltf::Scene& scene,
                                                    const compiler::CompileSettings& settings,
                                                    Renderer::Counters* counters = nullptr) {
    RenderSetup setup = defaultSetup(scene, 16, 16);
    setup.samples = 2;
    setup.frame.sky = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    std::map<package::Strategy, LinearImage> pictures;
    const LoadedScene loaded(scene, settings);
    for (const package::Strategy strategy : package::strategies()) {
        pictures[strategy] = loaded.render(strategy, setup, counters);
    }
    return pictures;
}

class EffectOfThePage : public ::testing::Test {
protected:
    void SetUp() override {
        test::writePrintedFiles("effects.md", folder_.path(),
                                {"translucency/translucency.json", "translucency/translucency.glsl"});
    }

    const materials::MaterialModel& model() {
        return *must(materials::loadMaterialModel(std::vector{folder_.path().string()}));
    }

    test::TemporaryFolder folder_;
};

// The two files are all that there is; no source of Glint's changes.
TEST_F(EffectOfThePage, BringsTheLightFromBehind) {
    const gltf::Scene scene = sheetAndPanel(model());
    Renderer::Counters counters;
    const auto pictures = picturesOf(scene, settingsWith({"translucency"}), &counters);
    ASSERT_EQ(pictures.size(), package::strategies().size());
    const LinearImage& reference = pictures.begin()->second;
    for (const auto& [strategy, picture] : pictures) {
        expectSameImage(picture, reference, std::string(package::nameOf(strategy)));
    }
    // Every ray finds the panel, whatever its direction, so the picture has no noise.
    for (const Pixel& pixel : reference.pixels) {
        for (std::size_t channel = 0; channel < 3; ++channel) {
            EXPECT_NEAR(pixel[channel], kTransmitted * kSheet[channel] * kPanel[channel], 2e-3F);
        }
    }
    ASSERT_EQ(counters.effects.size(), 1U);
    EXPECT_EQ(counters.effects[0].name, "translucency");
    EXPECT_EQ(counters.effects[0].rays, 16U * 16U);
}

TEST_F(EffectOfThePage, LeavesNothingWhereItIsNotNamed) {
    const gltf::Scene scene = sheetAndPanel(model());
    compiler::CompileSettings settings = settingsWith({});
    settings.effects.automatic = true;
    settings.strategies = package::kStrategyUber;
    const compiler::CompiledPackage package = must(compilePackage(scene, settings));
    EXPECT_EQ(package.plan.effects.effects.all, 0U);
    const compiler::EffectDecision& decision = package.plan.effects.decisions.back();
    EXPECT_EQ(decision.name, "translucency");
    EXPECT_TRUE(decision.usable);
    EXPECT_EQ(decision.reason, "refines the sky's light; no file asks for it, so it has to be named");
    for (const compiler::CompiledModule& module : package.modules) {
        EXPECT_EQ(module.name.find("translucency"), std::string::npos) << module.name;
    }
}

TEST_F(EffectOfThePage, MayComposeItsLight) {
    const auto path = folder_.path() / "translucency" / "translucency.json";
    base::Bytes bytes = must(base::readFile(path));
    std::string text(bytes.begin(), bytes.end());
    const std::string sample = "\"sample\": \"translucency.glsl\"";
    const std::size_t place = text.find(sample);
    ASSERT_NE(place, std::string::npos);
    text.insert(place + sample.size(), ", \"compose\": \"compose.glsl\"");
    ASSERT_TRUE(base::writeFile(path, text));
    ASSERT_TRUE(base::writeFile(folder_.path() / "translucency" / "compose.glsl",
                                "vec3 composeTranslucency(vec3 weight, vec3 radiance) {\n"
                                "    return 0.5 * weight * radiance;\n}\n"));
    compiler::CompileSettings settings = settingsWith({"translucency"});
    settings.strategies = package::kStrategyUber;
    const gltf::Scene scene = sheetAndPanel(model());
    RenderSetup setup = defaultSetup(scene, 8, 8);
    setup.frame.sky = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    const LoadedScene loaded(scene, settings);
    const LinearImage picture = loaded.render(package::kStrategyUber, setup);
    EXPECT_NEAR(picture.pixels[0][0], 0.5F * kTransmitted * kSheet[0] * kPanel[0], 2e-3F);
}

TEST_F(EffectOfThePage, ErrorsOfGlslNameTheFileTheLineAndTheEffect) {
    const auto path = folder_.path() / "translucency" / "translucency.glsl";
    ASSERT_TRUE(
        base::writeFile(path,
                        "#include \"effects/sample.glsl\"\n"
                        "#include \"effects/sky_shares.glsl\"\n"
                        "#include \"hit/surface.glsl\"\n"
                        "EffectSample sampleTranslucency(Hit hit, Surface surface, Features features,\n"
                        "                                inout SkyShares sky) {\n"
                        "    return nonsense;\n"
                        "}\n"));
    const Diagnostic package =
        mustFail(compilePackage(sheetAndPanel(model()), settingsWith({"translucency"})));
    EXPECT_EQ(package.id, "glsl");
    EXPECT_EQ(package.where, path.string() + ":6");
    EXPECT_NE(package.message.find("effect translucency"), std::string::npos) << package.message;
}

// In Glint's own sources the same folder needs no other change either: the declarations that the build would
// embed are those of the sources and this one, and the package is the same.
TEST_F(EffectOfThePage, IsTheSameInTheSources) {
    const std::string name = "effects/translucency/translucency";
    std::map<std::string, std::string> texts;
    for (const char* const extension : {".json", ".glsl"}) {
        const base::Bytes bytes =
            must(base::readFile(folder_.path() / ("translucency/translucency" + std::string(extension))));
        texts[extension] = std::string(bytes.begin(), bytes.end());
    }
    std::vector<materials::DeclarationFile> files;
    for (const base::BuiltinFile& file : materials::declarationFiles()) {
        files.push_back({file.name, file.text});
    }
    const std::string declaration = name + ".json";
    files.push_back({declaration, texts[".json"]});
    materials::MaterialModel built = must(readDeclarations(files));
    built.sources.push_back({name + ".glsl", texts[".glsl"]});
    const auto modulesOf = [](const gltf::Scene& scene) {
        const Result<compiler::CompiledPackage> package =
            compilePackage(scene, settingsWith({"translucency"}));
        EXPECT_TRUE(package) << toString(package.error());
        std::map<std::string, std::uint64_t> hashes;
        for (const compiler::CompiledModule& module :
             package ? package->modules : std::vector<compiler::CompiledModule>{}) {
            hashes[module.name] = module.hash;
        }
        return hashes;
    };
    const auto own = modulesOf(sheetAndPanel(built));
    EXPECT_EQ(own.count("translucency_rays.comp"), 1U);
    EXPECT_EQ(own, modulesOf(sheetAndPanel(model())));
}

}  // namespace
