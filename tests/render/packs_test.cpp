// Materials of packs: the example packs, and the pack that docs/material_features.md makes as it is printed.
#include "base/files.h"
#include "gltf/import.h"
#include "materials/declarations.h"
#include "render/pixel_test.h"
#include "support/must.h"
#include "support/printed_files.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace glint;
using namespace glint::testing;
namespace fs = std::filesystem;

const std::string kPacks = GLINT_SOURCE_DIR "/examples/materials";
const std::string kDrafts = kPacks + "/drafts";

const materials::MaterialModel& modelOf(const std::string& folder) {
    const Result<const materials::MaterialModel*> model = materials::loadMaterialModel(std::vector{folder});
    EXPECT_TRUE(model) << toString(model.error());
    return **model;
}

const materials::MaterialModel& packs() {
    static const materials::MaterialModel& model = modelOf(kPacks);
    return model;
}

class ExamplePacks : public ::testing::TestWithParam<std::string> {};
std::string nameOfFolder(const ::testing::TestParamInfo<std::string>& folder) {
    return std::array{"Examples", "Drafts", "Models", "OpenPbr"}[folder.index];
}
INSTANTIATE_TEST_SUITE_P(Folders, ExamplePacks,
                         ::testing::Values("materials", "materials/drafts", "materials/models",
                                           "materials/openpbr"),
                         nameOfFolder);

TEST_P(ExamplePacks, StrategiesAndMergePoliciesGiveOneImage) {
    const std::string folder = GLINT_SOURCE_DIR "/examples/" + GetParam();
    gltf::ImportOptions import;
    import.decodeImages = true;
    import.materialModel = &modelOf(folder);
    const gltf::Scene scene = must(importScene(folder + "/scene.gltf", import));
    EXPECT_TRUE(scene.warnings.empty()) << toString(scene.warnings.front());
    RenderSetup setup = defaultSetup(scene, 75, 30);
    setup.frame.maxReflectionRoughness = 1.0F;
    LinearImage reference;
    // PackStages has all strategies; here they are few, because the scene has many cases.
    const std::pair<compiler::MergePolicy, package::Strategy> ways[] = {
        {compiler::MergePolicy::None, package::kStrategyVisibility},
        {compiler::MergePolicy::All, package::kStrategyUber}};
    for (const auto& [merge, strategy] : ways) {
        compiler::CompileSettings settings;
        settings.plan.merge = merge;
        settings.plan.keys.alpha = package::AlphaPolicy::Tested;
        settings.strategies = strategy;
        const LoadedScene loaded(scene, settings);
        const LinearImage image = loaded.render(strategy, setup);
        reference = reference.pixels.empty() ? image : reference;
        expectSameImage(image, reference, std::string(nameOf(merge)));
    }
}

// A black wall with a layer, under one directional light without a sky. Returns the radiance along the axis
// of the camera, whose direction is the wall's normal turned by `tilt` radians about x.
Pixel litWall(const materials::Material& material, double tilt, gltf::Float3 light) {
    gltf::Scene scene = sceneWithCamera();
    const auto cosine = static_cast<float>(std::cos(tilt));
    const auto sine = static_cast<float>(std::sin(tilt));
    addQuad(scene, material, {-4, -4 * cosine, -4 - 4 * sine}, {8, 0, 0}, {0, 8 * cosine, 8 * sine});
    addDirectionalLight(scene, light, 2.0F);
    RenderSetup setup = defaultSetup(scene, 33, 33);
    setup.frame.sky = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    compiler::CompileSettings settings;
    settings.plan.merge = compiler::MergePolicy::None;
    settings.effects = {};
    const LoadedScene loaded(scene, settings);
    const LinearImage image = loaded.render(package::kStrategyVisibility, setup);
    return at(image, 16, 16);
}

struct Direction {
    double x, y, z;
};

// The wall of litWall() has x along the picture, y up the slope and its normal for z.
Direction toWall(gltf::Float3 world, double tilt) {
    return {world[0], world[1] * std::cos(tilt) + world[2] * std::sin(tilt),
            -world[1] * std::sin(tilt) + world[2] * std::cos(tilt)};
}

// Returns a material that reflects nothing but what layers add.
materials::Material blackMaterial(const materials::MaterialModel& model) {
    materials::Material material(model);
    material["baseColorFactor"] = {0, 0, 0, 1};
    material["metallicFactor"] = 0.0F;
    material.give("KHR_materials_specular");
    material["specularFactor"] = 0.0F;
    return material;
}

constexpr double kTilt = -0.5;
constexpr gltf::Float3 kLight{0.18F, -0.1F, -0.97857550F};  // unit; light goes this way

TEST(Packs, RetroreflectionIsThatOfDoublePrecision) {
    materials::Material material = blackMaterial(packs());
    material.give("EXAMPLE_materials_retroreflection");
    material["retroreflectionFactor"] = 0.75F;
    material["retroreflectionColor"] = {1.0F, 0.5F, 0.25F};
    material["retroreflectionRoughness"] = 0.6F;
    const Pixel pixel = litWall(material, kTilt, kLight);
    const Direction v = toWall({0, 0, 1}, kTilt);
    const Direction l = toWall({-kLight[0], -kLight[1], -kLight[2]}, kTilt);
    // D and V of GGX (Walter et al. 2007, Heitz 2014) about the view mirrored at the normal.
    const double alpha2 = std::pow(0.6, 4.0);
    const Direction sum{l.x - v.x, l.y - v.y, l.z + v.z};
    const double cosine = sum.z / std::sqrt(sum.x * sum.x + sum.y * sum.y + sum.z * sum.z);
    const double d = alpha2 / (std::numbers::pi * std::pow(cosine * cosine * (alpha2 - 1.0) + 1.0, 2.0));
    const auto projection = [&](double c) { return std::sqrt(alpha2 + (1.0 - alpha2) * c * c); };
    const double visibility = 0.5 / (l.z * projection(v.z) + v.z * projection(l.z));
    const double expected = 2.0 * 0.75 * d * visibility * l.z;
    ASSERT_GT(expected, 0.01);
    EXPECT_NEAR(pixel[0], expected, 1e-4 * expected);
    EXPECT_NEAR(pixel[1], 0.5 * expected, 1e-4 * expected);
    EXPECT_NEAR(pixel[2], 0.25 * expected, 1e-4 * expected);
}

TEST(Packs, FibresAreThoseOfDoublePrecision) {
    materials::Material material = blackMaterial(packs());
    material.give("EXAMPLE_materials_fibre");
    material["fibreFactor"] = 0.5F;
    material["fibreWidth"] = 0.2F;
    material["fibreRotation"] = 0.4F;
    const Pixel pixel = litWall(material, kTilt, kLight);
    const Direction v = toWall({0, 0, 1}, kTilt);
    const Direction l = toWall({-kLight[0], -kLight[1], -kLight[2]}, kTilt);
    const auto along = [](const Direction& d) { return std::cos(0.4) * d.x + std::sin(0.4) * d.y; };
    const double centre = -along(v);
    const double distance = (along(l) - centre) / 0.2;
    const double range = std::atan((1.0 - centre) / 0.2) - std::atan((-1.0 - centre) / 0.2);
    const double expected = 2.0 * 0.5 / (0.2 * (1.0 + distance * distance) * range * std::numbers::pi);
    ASSERT_GT(expected, 0.01);
    for (int channel = 0; channel < 3; ++channel) {
        EXPECT_NEAR(pixel[static_cast<std::size_t>(channel)], expected, 1e-4 * expected);
    }
}

TEST(Packs, AGroovedCoatIsThatOfDoublePrecision) {
    static const materials::MaterialModel& model = modelOf(kDrafts);
    materials::Material material = blackMaterial(model);
    material.give("KHR_materials_coat");
    material["coatFactor"] = 0.75F;
    material["coatRoughnessFactor"] = 0.5F;
    material["coatIor"] = 1.6F;
    material["coatAnisotropyStrength"] = 0.6F;
    material["coatAnisotropyRotation"] = 0.4F;
    const Pixel pixel = litWall(material, kTilt, kLight);
    // Vectors along the grooves and across them.
    const auto turned = [](const Direction& d) {
        return Direction{std::cos(0.4) * d.x + std::sin(0.4) * d.y, std::cos(0.4) * d.y - std::sin(0.4) * d.x,
                         d.z};
    };
    const Direction v = turned(toWall({0, 0, 1}, kTilt));
    const Direction l = turned(toWall({-kLight[0], -kLight[1], -kLight[2]}, kTilt));
    // glTF 2.0, appendix B, with the alphas of KHR_materials_anisotropy.
    const double across = 0.25;
    const double along = across + (1.0 - across) * 0.36;
    const double size = std::sqrt(std::pow(v.x + l.x, 2) + std::pow(v.y + l.y, 2) + std::pow(v.z + l.z, 2));
    const Direction h{(v.x + l.x) / size, (v.y + l.y) / size, (v.z + l.z) / size};
    const double stretched = std::pow(h.x / along, 2) + std::pow(h.y / across, 2) + h.z * h.z;
    const double d = 1.0 / (std::numbers::pi * along * across * stretched * stretched);
    const auto projection = [&](const Direction& w) {
        return std::sqrt(std::pow(along * w.x, 2) + std::pow(across * w.y, 2) + w.z * w.z);
    };
    const double visibility = 0.5 / (l.z * projection(v) + v.z * projection(l));
    const double f0 = std::pow(0.6 / 2.6, 2);
    const double fresnel = f0 + (1.0 - f0) * std::pow(1.0 - 0.5 * size, 5);
    const double expected = 2.0 * 0.75 * fresnel * d * visibility * l.z;
    ASSERT_GT(expected, 1e-3);
    EXPECT_NEAR(pixel[0], expected, 1e-4 * expected);
    EXPECT_NEAR(pixel[2], expected, 1e-4 * expected);
}

// The page's lobe is added by the three files that it prints, and by nothing else.
TEST(Packs, ThePageAddsALobe) {
    const test::TemporaryFolder folder;
    test::writePrintedFiles("material_features.md", folder.path(),
                            {"wax/wax.json", "wax/wax.glsl", "wax/wax_bsdf.glsl"});
    const materials::MaterialModel* model =
        must(materials::loadMaterialModel(std::vector{folder.path().string()}));
    materials::Material material = blackMaterial(*model);
    material.give("EXAMPLE_materials_wax");
    material["waxFactor"] = 0.5F;
    const Pixel pixel = litWall(material, kTilt, kLight);
    // Lambert's law.
    const Direction l = toWall({-kLight[0], -kLight[1], -kLight[2]}, kTilt);
    EXPECT_NEAR(pixel[0], 2.0 * 0.5 * l.z / std::numbers::pi, 1e-4);
}

// An array, an enum and a bool, as the page prints them, with its list of materials.
TEST(Packs, ThePageAddsBandsOfColour) {
    const test::TemporaryFolder folder;
    test::writePrintedFiles("material_features.md", folder.path(),
                            {"strata/strata.json", "strata/strata.glsl", "cliff.json"});
    gltf::ImportOptions options;
    options.materialModel =
        must(materials::loadMaterialModel(std::vector{(folder.path() / "strata").string()}));
    const gltf::Scene list = must(gltf::importScene(folder.path() / "cliff.json", options));
    EXPECT_TRUE(list.warnings.empty());
    EXPECT_EQ(list.animatedMaterials.at(0).edited, std::vector<std::string>{"strataTurns false or true"});
    materials::Material cliff = list.materials[0];
    cliff["metallicFactor"] = 0.0F;
    cliff.give("KHR_materials_specular");
    cliff["specularFactor"] = 0.0F;
    const auto pixelOf = [&](const std::function<void(materials::Material&)>& change) {
        materials::Material material = cliff;
        change(material);
        gltf::Scene scene = sceneWithCamera();
        addQuad(scene, material, {-4, -4, -4}, {8, 0, 0}, {0, 8, 0});
        addDirectionalLight(scene, {0, 0, -1}, 2.0F);
        compiler::CompileSettings settings;
        settings.strategies = package::kStrategyUber;
        settings.effects = {false, compiler::builtinEffects({})};
        const LinearImage image =
            LoadedScene(scene, settings).render(package::kStrategyUber, darkSetup(scene, 16));
        Pixel pixel = at(image, 8, 6);
        for (float& channel : pixel) {
            channel *= std::numbers::pi_v<float> / 2.0F;
        }
        return pixel;
    };
    // Pixel 6 of 16 is at the height 4 * (1 - 2 * 6.5 / 16).
    expectColor(pixelOf([](materials::Material&) {}), {0.25F, 0.5F, 0.75F}, 1e-4F, "hard");
    expectColor(pixelOf([](materials::Material& one) { one["strataEdge"] = 0.0; }),
                {0.3125F, 0.4375F, 0.59375F}, 1e-4F, "soft");
    expectColor(pixelOf([](materials::Material& one) { one["strataTurns"] = 1.0; }), {0.75F, 0.75F, 0.5F},
                1e-4F, "turned");
}

TEST(Packs, ErrorsOfGlslNameTheFileTheLineAndTheFeature) {
    const test::TemporaryFolder folder;
    fs::copy(kPacks + "/retroreflection", folder.path() / "retroreflection");
    const fs::path file = folder.path() / "retroreflection" / "retroreflection_bsdf.glsl";
    ASSERT_TRUE(
        base::writeFile(file,
                        "#include \"hit/surface_values.glsl\"\n\n"
                        "void retroreflectionBsdf(Hit hit, Features features, inout SurfaceValues values,\n"
                        "                         inout Surface surface) {\n"
                        "    nonsense = 1.0;\n"
                        "}\n"));
    const materials::MaterialModel* model =
        must(materials::loadMaterialModel(std::vector{folder.path().string()}));
    materials::Material material = blackMaterial(*model);
    material.give("EXAMPLE_materials_retroreflection");
    material["retroreflectionFactor"] = 0.75F;
    gltf::Scene scene = sceneWithCamera();
    addQuad(scene, material, {-1, -1, -2}, {2, 0, 0}, {0, 2, 0});
    const Diagnostic package = mustFail(compiler::compilePackage(scene, {}));
    EXPECT_EQ(package.id, "glsl");
    EXPECT_EQ(package.where, file.string() + ":5");
    EXPECT_NE(package.message.find("feature retroreflection"), std::string::npos) << package.message;
}

// Returns the texts of the modules of the example scene, by name, with the packs of `folder`.
std::map<std::string, std::string> moduleTexts(const std::string& folder) {
    gltf::ImportOptions import;
    const Result<const materials::MaterialModel*> model = materials::loadMaterialModel(std::vector{folder});
    EXPECT_TRUE(model) << toString(model.error());
    import.materialModel = *model;
    const Result<gltf::Scene> scene = importScene(kPacks + "/scene.gltf", import);
    EXPECT_TRUE(scene) << toString(scene.error());
    compiler::CompileSettings settings;
    settings.plan.merge = compiler::MergePolicy::None;
    settings.strategies = package::kStrategyVisibility;
    const Result<compiler::PackagePlan> plan = planPackage({&*scene, 1}, settings);
    EXPECT_TRUE(plan) << toString(plan.error());
    std::map<std::string, std::string> texts;
    for (const compiler::PlannedModule& module : plan->modules) {
        texts[module.name] = module.text;
    }
    return texts;
}

TEST(Packs, AChangeOfGlslChangesItsCaseAlone) {
    const test::TemporaryFolder folder;
    fs::copy(kPacks, folder.path(), fs::copy_options::recursive);
    const std::map<std::string, std::string> before = moduleTexts(folder.path().string());
    const fs::path file = folder.path() / "fibre" / "fibre.glsl";
    const base::Bytes bytes = must(base::readFile(file));
    std::string text(bytes.begin(), bytes.end());
    const std::size_t place = text.find("return kInversePi /");
    ASSERT_NE(place, std::string::npos);
    text.insert(place + 7, "0.5 * ");
    ASSERT_TRUE(base::writeFile(file, text));
    const std::map<std::string, std::string> after = moduleTexts(folder.path().string());
    ASSERT_EQ(before.size(), after.size());
    std::vector<std::string> changed;
    for (const auto& [name, module] : before) {
        if (after.at(name) != module) {
            changed.push_back(name);
        }
    }
    ASSERT_EQ(changed.size(), 2U);
    for (const std::string& name : changed) {
        EXPECT_NE(name.find("Fibre"), std::string::npos) << name;
    }
    EXPECT_TRUE(changed[0].starts_with("first_") && changed[1].starts_with("shade_")) << changed[0];
}

}  // namespace
