// Models of packs, in place of glTF's base: examples/materials/models.
#include "base/files.h"
#include "gltf/import.h"
#include "materials/declarations.h"
#include "plan/effects.h"
#include "plan/key.h"
#include "render/harness.h"
#include "render/light_pictures.h"
#include "render/pixel_test.h"
#include "render/scene_builder.h"
#include "support/must.h"
#include "support/printed_files.h"
#include "support/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <initializer_list>
#include <numbers>
#include <regex>
#include <string>
#include <string_view>
#include <vector>

namespace {

using namespace glint;
using namespace glint::testing;

const materials::MaterialModel& models() {
    static const materials::MaterialModel& model = []() -> const materials::MaterialModel& {
        const Result<const materials::MaterialModel*> loaded = materials::loadMaterialModel(
            std::vector<std::string>{GLINT_SOURCE_DIR "/examples/materials/models"});
        EXPECT_TRUE(loaded) << toString(loaded.error());
        return **loaded;
    }();
    return model;
}

constexpr gltf::Float3 kColor{0.6F, 0.4F, 0.2F};

// A surface that scatters by Lambert's law: the model leaf without passage, or glTF's base without
// reflection.
materials::Material lambert(bool ofPack) {
    materials::Material material(models());
    if (ofPack) {
        material.give("EXAMPLE_materials_leaf");
        material["leafPassed"] = {0.0F, 0.0F, 0.0F};
    } else {
        material["metallicFactor"] = 0.0F;
        material.give("KHR_materials_specular");
        material["specularFactor"] = 0.0F;
    }
    material["baseColorFactor"] = {kColor[0], kColor[1], kColor[2], 1.0F};
    return material;
}

// A corner of two walls and a floor under a lamp and a directional light, with a mirror.
gltf::Scene corner(bool ofPack) {
    gltf::Scene scene = sceneWithCamera();
    addQuad(scene, lambert(ofPack), {-3, -1, -6}, {6, 0, 0}, {0, 4, 0});
    addQuad(scene, lambert(ofPack), {-3, -1, 1}, {6, 0, 0}, {0, 0, -7});
    materials::Material lamp(models());
    lamp["baseColorFactor"] = {0.0F, 0.0F, 0.0F, 1.0F};
    lamp["emissiveFactor"] = {1.0F, 0.8F, 0.6F};
    lamp["emissiveStrength"] = 4.0F;
    addQuad(scene, lamp, {-1, 2, -5}, {0, 0, 1.5F}, {1.5F, 0, 0});
    materials::Material mirror(models());
    mirror["roughnessFactor"] = 0.0F;
    addQuad(scene, mirror, {1.2F, -0.9F, -5}, {1, 0, 1}, {0, 1.5F, 0});
    addDirectionalLight(scene, {0.3F, -0.8F, -0.52F}, 1.5F);
    return scene;
}

struct LambertWay {
    const char* name;
    compiler::EmissiveLights emissive;
    compiler::SkyLight sky;
    std::uint32_t bounces;
    package::Strategy strategy;
};

// The same numbers choose the same directions, so pictures are equal, not only their means.
TEST(Models, LambertsLawGivesThePictureOfGltfsBase) {
    using compiler::EmissiveLights;
    using compiler::SkyLight;
    for (const LambertWay& way :
         {LambertWay{"one bounce", EmissiveLights::Off, SkyLight::Off, 1, package::kStrategyUber},
          LambertWay{"lamps are lights", EmissiveLights::On, SkyLight::Off, 1, package::kStrategyVisibility},
          LambertWay{"paths", EmissiveLights::On, SkyLight::On, 3, package::kStrategySortedUber}}) {
        compiler::CompileSettings settings;
        settings.strategies = way.strategy;
        settings.emissiveLights = way.emissive;
        settings.skyLight = way.sky;
        settings.maxBounces = way.bounces;
        settings.effects = {false, compiler::builtinEffects({"shadow", "reflection", "indirect-diffuse"})};
        LinearImage reference;
        for (const bool ofPack : {false, true}) {
            const gltf::Scene scene = corner(ofPack);
            const LoadedScene loaded(scene, settings);
            RenderSetup setup = defaultSetup(scene, 24, 24);
            setup.samples = 4;
            RendererOptions options;
            options.strategy = way.strategy;
            options.bounces = way.bounces;
            const LinearImage image = loaded.render(options, setup);
            if (ofPack) {
                expectSameImage(image, reference, way.name);
                EXPECT_GT(meanOf(image), 0.05) << way.name;
            }
            reference = image;
        }
    }
}

// The light that goes along `direction` from a wall at right angles to the view to the camera, without a sky.
Pixel litBy(const materials::Material& material, gltf::Float3 direction) {
    gltf::Scene scene = sceneWithCamera();
    addQuad(scene, material, {-4, -4, -4}, {8, 0, 0}, {0, 8, 0});
    addDirectionalLight(scene, direction, 2.0F);
    RenderSetup setup = defaultSetup(scene, 17, 17);
    setup.frame.sky = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    compiler::CompileSettings settings;
    settings.effects = {false, compiler::builtinEffects({"shadow"})};
    settings.strategies = package::kStrategyUber;
    const LoadedScene loaded(scene, settings);
    const LinearImage image = loaded.render(package::kStrategyUber, setup);
    return at(image, 8, 8);
}

void expectLight(const Pixel& pixel, double share, const std::string& what) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
        const double expected = 2.0 * static_cast<double>(kColor[channel]) * share / std::numbers::pi;
        EXPECT_NEAR(pixel[channel], expected, 1e-5) << what;
    }
}

void expectTone(const Pixel& pixel, double tone) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
        EXPECT_NEAR(pixel[channel], static_cast<double>(kColor[channel]) * tone, 1e-5);
    }
}

TEST(Models, ToonHasTheCosineInSteps) {
    materials::Material material(models());
    material.give("EXAMPLE_materials_toon");
    material["toonColor"] = {kColor[0], kColor[1], kColor[2], 1.0F};
    for (const auto& [cosine, step] :
         {std::pair{0.9, 1.0}, {0.6, 2.0 / 3.0}, {0.45, 1.0 / 3.0}, {0.1, 0.0}}) {
        const auto sine = static_cast<float>(std::sqrt(1.0 - cosine * cosine));
        expectLight(litBy(material, {sine, 0, -static_cast<float>(cosine)}), step, std::to_string(cosine));
    }
}

TEST(Models, ALeafPassesLightFromBehind) {
    materials::Material material = lambert(true);
    material["leafPassed"] = {0.25F, 0.25F, 0.25F};
    expectLight(litBy(material, {0.6F, 0, -0.8F}), 0.75 * 0.8, "from the front");
    expectLight(litBy(material, {0.6F, 0, 0.8F}), 0.25 * 0.8, "from behind");
    material["leafPassed"] = {0.0F, 0.0F, 0.0F};
    expectLight(litBy(material, {0.6F, 0, 0.8F}), 0.0, "of which nothing passes");
}

TEST(Models, AHighlightIsThatOfDoublePrecision) {
    materials::Material material(models());
    material.give("EXAMPLE_materials_blinn_phong");
    material["blinnPhongDiffuse"] = {0.0F, 0.0F, 0.0F, 1.0F};
    material["blinnPhongSpecular"] = {kColor[0], kColor[1], kColor[2]};
    material["blinnPhongShininess"] = 20.0F;
    // Between the view along the normal and the light lies half of its angle.
    const double half = std::cos(0.5 * std::acos(0.8));
    const double scale = 22.0 * 24.0 / (8.0 * (std::exp2(-10.0) + 20.0));
    expectLight(litBy(material, {0.6F, 0, -0.8F}), scale * std::pow(half, 20.0) * 0.8, "");
}

// Rays of a model are those of indirect diffuse, so the effect reflection adds nothing and takes nothing
// away: neither where the sky stands in for the model's light, nor where samples of the sky share it.
TEST(Models, ReflectionSendsNoRaysOfTheirs) {
    materials::Material shiny(models());
    shiny.name = "Shiny";
    shiny.give("EXAMPLE_materials_blinn_phong");
    shiny["blinnPhongDiffuse"] = {0.1F, 0.1F, 0.1F, 1.0F};
    shiny["blinnPhongSpecular"] = {0.8F, 0.7F, 0.6F};
    shiny["blinnPhongShininess"] = 300.0F;
    gltf::Scene scene = sceneWithCamera();
    addQuad(scene, shiny, {-3, -1, -6}, {6, 0, 0}, {0, 4, 0});
    addQuad(scene, lambert(true), {-3, -1, 1}, {6, 0, 0}, {0, 0, -7});
    addDirectionalLight(scene, {0.3F, -0.8F, -0.52F}, 1.5F);
    for (const compiler::SkyLight skyLight : {compiler::SkyLight::Off, compiler::SkyLight::On}) {
        const auto draw = [&](std::initializer_list<std::string_view> effects) {
            compiler::CompileSettings settings;
            settings.strategies = package::kStrategyUber;
            settings.skyLight = skyLight;
            settings.effects = {false, compiler::builtinEffects(effects)};
            RenderSetup setup = defaultSetup(scene, 16, 16);
            setup.samples = 2;
            return LoadedScene(scene, settings).render(package::kStrategyUber, setup);
        };
        expectSameImage(draw({"shadow", "reflection"}), draw({"shadow"}), "reflection alone");
        if (skyLight == compiler::SkyLight::Off) {
            // Samples of the sky at hits depend on the place of the ray among those of all effects.
            const LinearImage followed = draw({"shadow", "indirect-diffuse"});
            EXPECT_GT(meanOf(followed), 0.05);
            expectSameImage(draw({"shadow", "reflection", "indirect-diffuse"}), followed, "both");
        }
    }
    const materials::PrimitiveInputs primitive{.hasNormals = true};
    const compiler::EffectPlan plan =
        compiler::decideEffects({&shiny, 1}, {&primitive, 1}, {.lit = true}, {.automatic = true});
    EXPECT_EQ(
        plan.decisions[package::effectNumber(compiler::builtinEffects({"reflection"}))].reason,
        "no surface is smoother than the roughness limit 0.3 (material \"Shiny\" has the model blinnPhong, "
        "whose rays are those of indirect-diffuse)");
}

// The documents print the model, and a list of materials with it, as they are.
TEST(Models, AreAsTheDocumentsPrintThem) {
    const test::TemporaryFolder folder;
    test::writePrintedFiles("material_features.md", folder.path(),
                            {"toon/toon.json", "toon/toon.glsl", "toon/toon_surface.glsl"});
    for (const char* const file : {"toon/toon.json", "toon/toon.glsl", "toon/toon_surface.glsl"}) {
        const Result<base::Bytes> printed = base::readFile(folder.path() / file);
        const Result<base::Bytes> kept =
            base::readFile(std::filesystem::path(GLINT_SOURCE_DIR "/examples/materials/models") / file);
        ASSERT_TRUE(printed && kept) << file;
        EXPECT_EQ(*printed, *kept) << file;
    }
    test::writePrintedFiles("material_lists.md", folder.path(), {"materials.json"});
    gltf::ImportOptions options;
    options.materialModel = &models();
    const gltf::Scene list = must(importScene(folder.path() / "materials.json", options));
    EXPECT_TRUE(list.warnings.empty()) << toString(list.warnings.front());
    EXPECT_EQ(list.materials.size(), 4U);
}

// Copies the model leaf under the name leaf<i>, with three textures of its own.
void writeLeaf(const std::filesystem::path& folder, int number) {
    const std::filesystem::path from = GLINT_SOURCE_DIR "/examples/materials/models/leaf";
    const std::string name = "leaf" + std::to_string(number);
    std::filesystem::create_directory(folder / name);
    for (const char* const ending : {".json", ".glsl", "_surface.glsl"}) {
        const base::Bytes bytes = must(base::readFile(from / (std::string("leaf") + ending)));
        std::string text(bytes.begin(), bytes.end());
        for (const auto& [word, by] : {std::pair<std::string, std::string>{"leaf", name},
                                       {"Leaf", "L" + name.substr(1)},
                                       {"LEAF", "LEAF" + std::to_string(number)}}) {
            text = std::regex_replace(text, std::regex(word), by);
        }
        std::string textures = "\"textures\": [";
        for (const char* const map : {"A", "B", "C"}) {
            textures += "{\"name\": \"" + name + map + "\"}, ";
        }
        text = std::regex_replace(text, std::regex("\"textures\": \\["), textures);
        ASSERT_TRUE(base::writeFile(folder / name / (name + ending), text));
    }
}

// Each of forty models has a base and three textures, which is more than the 64 bits that models share.
TEST(Models, OneOfManyGivesThePictureOfOneAlone) {
    constexpr int kCount = 40;
    const test::TemporaryFolder folder;
    for (int i = 0; i < kCount; ++i) {
        writeLeaf(folder.path(), i);
    }
    const materials::MaterialModel* const many =
        must(materials::loadMaterialModel(std::vector{folder.path().string()}));
    EXPECT_EQ(many->models.size(), static_cast<std::size_t>(kCount));
    const auto wall = [](const materials::MaterialModel& model, const std::string& name, float passed) {
        materials::Material material(model);
        material.give("EXAMPLE_materials_" + name);
        material[name + "Passed"] = {passed, passed, 0.0F};
        material["baseColorFactor"] = {kColor[0], kColor[1], kColor[2], 1.0F};
        return material;
    };
    for (const auto& [merge, strategy] :
         {std::pair{compiler::MergePolicy::None, package::kStrategyVisibility},
          {compiler::MergePolicy::All, package::kStrategyUber}}) {
        LinearImage reference;
        for (const bool ofMany : {false, true}) {
            const materials::MaterialModel& model = ofMany ? *many : models();
            gltf::Scene scene = emptyScene();
            addCamera(scene);
            const std::string first = ofMany ? "leaf3" : "leaf";
            const std::string second = ofMany ? "leaf39" : "leaf";
            addQuad(scene, wall(model, first, 0.2F), {-3, -1, -6}, {6, 0, 0}, {0, 4, 0});
            addQuad(scene, wall(model, second, 0.6F), {-3, -1, 1}, {6, 0, 0}, {0, 0, -7});
            materials::Material mirror(model);
            mirror["roughnessFactor"] = 0.0F;
            addQuad(scene, mirror, {0.5F, -0.9F, -5}, {1, 0, 1}, {0, 1.5F, 0});
            addDirectionalLight(scene, {0.3F, -0.8F, -0.52F}, 1.5F);
            compiler::CompileSettings settings;
            settings.plan.merge = merge;
            settings.strategies = strategy;
            settings.effects = {false, compiler::builtinEffects({"shadow", "reflection"})};
            const LoadedScene loaded(scene, settings);
            const LinearImage image = loaded.render(strategy, defaultSetup(scene, 24, 24));
            if (ofMany) {
                expectSameImage(image, reference, "merged by " + std::string(nameOf(merge)));
                EXPECT_GT(meanOf(image), 0.05);
            }
            reference = image;
        }
    }
}

// A wall and a floor of the model cel, seen in a mirror too, under lights that come with the same cosine to
// both.
gltf::Scene celRoom(const materials::MaterialModel& model, int lights, bool blocked) {
    materials::Material cel(model);
    cel.give("EXAMPLE_materials_cel");
    cel["celColor"] = {kColor[0], kColor[1], kColor[2], 1.0F};
    gltf::Scene scene = sceneWithCamera();
    addQuad(scene, cel, {-3, -1, -6}, {6, 0, 0}, {0, 4, 0});
    addQuad(scene, cel, {-3, -1, 1}, {6, 0, 0}, {0, 0, -7});
    materials::Material mirror(model);
    mirror["roughnessFactor"] = 0.0F;
    addQuad(scene, mirror, {1.2F, -0.9F, -5}, {1, 0, 1}, {0, 1.5F, 0});
    if (blocked) {
        addQuad(scene, mirror, {-40, 30, 1000}, {0, 0, -2000}, {39, 0, 0});
    }
    for (int i = 0; i < lights; ++i) {
        addDirectionalLight(scene, {i == 0 ? 0.48F : -0.48F, -0.62F, -0.62F},
                            3.0F / static_cast<float>(lights));
    }
    return scene;
}

// Two lights of half the strength give the picture of one, in first hits and in the mirror. One of the two in
// shadow takes half of their tone away.
TEST(Models, OneThatShadesAllLightsHasTheToneOfTheirSum) {
    const test::TemporaryFolder folder;
    test::writePrintedFiles("material_features.md", folder.path(),
                            {"cel/cel.json", "cel/cel.glsl", "cel/cel_surface.glsl"});
    const materials::MaterialModel& model =
        *must(materials::loadMaterialModel(std::vector{folder.path().string()}));
    for (const package::Strategy strategy : {package::kStrategyVisibility, package::kStrategyHitShaders}) {
        const auto draw = [&](int lights, bool shadows, bool blocked) {
            const gltf::Scene scene = celRoom(model, lights, blocked);
            compiler::CompileSettings settings;
            settings.strategies = strategy;
            settings.effects = {false, compiler::builtinEffects({shadows ? "shadow" : "reflection"})};
            RenderSetup setup = defaultSetup(scene, 25, 25);
            setup.frame.sky = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
            return LoadedScene(scene, settings).render(strategy, setup);
        };
        const LinearImage one = draw(1, false, false);
        expectSameImage(draw(2, false, false), one, "two lights");
        // 3 cos / π = 0.59, of which the tone is two thirds.
        expectTone(at(one, 8, 6), 2.0 / 3.0);
        expectTone(at(draw(2, true, false), 8, 6), 2.0 / 3.0);
        expectTone(at(draw(2, true, true), 8, 6), 1.0 / 3.0);
    }
}

// The same function in HLSL and in GLSL.
TEST(Models, OneInHlslGivesThePictureOfGlsl) {
    const test::TemporaryFolder printed;
    const test::TemporaryFolder folder;
    test::writePrintedFiles("material_features.md", printed.path(), {"cel/cel.json", "cel/cel_surface.glsl"});
    test::writePrintedFiles("material_features.md", folder.path(), {"chalk/chalk.hlsl", "chalk/chalk.glsl"});
    const std::string chalk = (folder.path() / "chalk/chalk").string();
    for (const char* const ending : {".json", "_surface.glsl"}) {
        const base::Bytes bytes = must(base::readFile(printed.path() / (std::string("cel/cel") + ending)));
        std::string text(bytes.begin(), bytes.end());
        for (const auto& [word, by] :
             {std::pair{", \"shadesAll\": true", ""}, {"cel", "chalk"}, {"Cel", "Chalk"}}) {
            text = std::regex_replace(text, std::regex(word), by);
        }
        ASSERT_TRUE(base::writeFile(chalk + ending, text));
    }
    const std::string command = fmt::format(
        "glslangValidator -D -V -Od -S comp -e main --target-env vulkan1.2 '{0}.hlsl' -o '{0}.spv' "
        ">'{0}.log'",
        chalk);
    ASSERT_EQ(std::system(command.c_str()), 0);
    const auto draw = [&] {
        const materials::MaterialModel& model =
            *must(materials::loadMaterialModel(std::vector{folder.path().string()}));
        materials::Material material(model);
        material.give("EXAMPLE_materials_chalk");
        material["chalkColor"] = {kColor[0], kColor[1], kColor[2], 1.0F};
        gltf::Scene scene = sceneWithCamera();
        addQuad(scene, material, {-3, -1, -6}, {6, 0, 0}, {0, 4, 0});
        addDirectionalLight(scene, {0.3F, -0.8F, -0.52F}, 1.5F);
        return LoadedScene(scene, compiler::CompileSettings{})
            .render(package::kStrategyUber, defaultSetup(scene, 16, 16));
    };
    const LinearImage inHlsl = draw();
    EXPECT_GT(meanOf(inHlsl), 0.05);
    ASSERT_TRUE(base::writeFile(chalk + ".glsl",
                                "#include \"bsdf/model.glsl\"\nstruct Chalk { vec3 color; };\n"
                                "void chalkPrepare(inout Chalk model, vec3 view) {}\n"
                                "vec3 chalkEvaluate(Chalk model, vec3 view, vec3 l) {\n"
                                "    return model.color * (l.z / 3.14159265);\n}\n"));
    expectSameImage(draw(), inHlsl, "as GLSL");
}

// A model that fills nothing of glTF's base, with so many features of its own that shaders need several
// words.
void writeZinc(const std::filesystem::path& folder, int features) {
    std::string declared;
    for (int i = 0; i < features; ++i) {
        const std::string name = "alloy" + std::to_string(i);
        declared += (i == 0 ? "" : ",\n") +
                    ("{\"name\": \"" + name + "\", \"gltf\": \"" + name +
                     "\", \"neutral\": [{\"when\": \"not has(zinc) or zincAlloy != " + std::to_string(i) +
                     "\", \"because\": \"it is another alloy\"}]}");
    }
    ASSERT_TRUE(base::writeFile(folder / "zinc.json", R"({
        "name": "zinc", "extension": "EXT_zinc", "stage": "base",
        "replaces": {"object": "pbrMetallicRoughness"},
        "glsl": {"surface": "zinc_surface.glsl", "bsdf": "zinc_surface.glsl", "model": "zinc.glsl"},
        "parameters": [{"name": "zincColor", "type": "color", "default": [0.2, 0.3, 0.4]},
                       {"name": "zincAlloy", "type": "float", "default": -1, "record": false},
                       {"name": "zincShare", "type": "float", "default": 1}],
        "features": [)" + declared + R"(],
        "effects": [{"does": "scatters", "when": "zincColor != 0"}]})"));
    ASSERT_TRUE(base::writeFile(folder / "zinc.glsl", R"(#include "bsdf/model.glsl"
struct Zinc {
    vec3 color;
};
void zincPrepare(inout Zinc model, vec3 view) {}
vec3 zincEvaluate(Zinc model, vec3 view, vec3 l) {
    return model.color * (kInversePi * max(l.z, 0.0));
}
)"));
    const std::string last = std::to_string(features - 1);
    ASSERT_TRUE(base::writeFile(folder / "zinc_surface.glsl", R"(#include "hit/surface_values.glsl"
void zincSurface(Hit hit, Features features, inout SurfaceValues values) {
    values.color = vec4(GLINT_MATERIAL_ZINC_COLOR(hit) * GLINT_MATERIAL_ZINC_SHARE(hit), 1.0);
    if (GLINT_HAS_ZINC_ALLOY_)" + last + R"((features)) {
        values.color.rgb = values.color.bgr;
    }
    if (GLINT_HAS_ZINC_ALLOY_1(features)) {
        values.color.rgb *= 0.5;
    }
}
void zincBsdf(Hit hit, Features features, inout SurfaceValues values, inout Surface surface) {
    surface.bsdf.layers.zinc = Zinc(values.color.rgb);
}
)"));
}

// Squares side by side. Each shows the same alone, in a package whose records have its own fields, as
// beside materials of other models, whose fields lie in the same place.
TEST(Models, ShowTheSameAloneAndAmongOthers) {
    constexpr int kFeatures = 100;
    const test::TemporaryFolder folder;
    writeZinc(folder.path(), kFeatures);
    const materials::MaterialModel& model = *must(materials::loadMaterialModel(
        std::vector<std::string>{folder.path().string(), GLINT_SOURCE_DIR "/examples/materials/models"}));
    std::vector<materials::Material> list;
    const auto add = [&](const char* extension) -> materials::Material& {
        list.emplace_back(model);
        if (extension != nullptr) {
            list.back().give(extension);
        }
        return list.back();
    };
    add("EXT_zinc");
    add("EXT_zinc")["zincAlloy"] = static_cast<float>(kFeatures - 1);
    add("EXT_zinc")["zincAlloy"] = 1.0F;
    materials::Material& lamp = add("EXT_zinc");
    lamp["emissiveFactor"] = {0.5F, 0.25F, 0.125F};
    lamp["emissiveStrength"] = 2.0F;
    materials::Material& masked = add("EXT_zinc");
    masked.alphaMode = materials::AlphaMode::Mask;
    masked["alphaCutoff"] = 0.75F;
    materials::Material& hole = add("EXAMPLE_materials_toon");
    hole.alphaMode = materials::AlphaMode::Mask;
    hole["toonColor"] = {0.6F, 0.4F, 0.2F, 0.5F};
    hole["alphaCutoff"] = 0.75F;
    materials::Material& coated = add("EXAMPLE_materials_blinn_phong");
    coated["blinnPhongSpecular"] = {0.1F, 0.2F, 0.3F};
    coated["clearcoatFactor"] = 0.5F;
    add("EXAMPLE_materials_toon")["toonBands"] = 5.0F;
    materials::Material& gltf = add(nullptr);
    gltf["emissiveFactor"] = {0.1F, 0.2F, 0.3F};
    const auto count = static_cast<int>(list.size());
    const auto sceneOf = [&](int only) {
        gltf::Scene scene = sceneWithCamera();
        for (int i = 0; i < count; ++i) {
            if (only < 0 || only == i) {
                const float x = -35.5F + 8.0F * static_cast<float>(i);
                addQuad(scene, list[static_cast<std::size_t>(i)], {x, -1, -4}, {7, 0, 0}, {0, 2, 0});
            }
        }
        addDirectionalLight(scene, {0.3F, -0.2F, -0.9F}, 2.0F);
        return scene;
    };
    for (const auto& [merge, strategy] :
         {std::pair{compiler::MergePolicy::None, package::kStrategyVisibility},
          {compiler::MergePolicy::All, package::kStrategyUber}}) {
        compiler::CompileSettings settings;
        settings.plan.merge = merge;
        settings.plan.keys.alpha = package::AlphaPolicy::Tested;
        settings.strategies = strategy;
        settings.effects = {false, compiler::builtinEffects({"shadow"})};
        const auto rendered = [&](int only) {
            const gltf::Scene scene = sceneOf(only);
            const LoadedScene loaded(scene, settings);
            RenderSetup setup = defaultSetup(scene, 90, 9);
            setup.frame.sky = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
            return loaded.render(strategy, setup);
        };
        const LinearImage all = rendered(-1);
        for (int i = 0; i < count; ++i) {
            const LinearImage alone = rendered(i);
            int shown = 0;
            for (std::uint32_t x = 0; x < all.width; ++x) {
                const Pixel one = at(alone, x, 4);
                if (one[0] + one[1] + one[2] > 0.0F) {
                    ++shown;
                    EXPECT_EQ(one, at(all, x, 4)) << "material " << i << ", column " << x;
                }
            }
            EXPECT_EQ(shown > 0, i != 5) << "material " << i;  // the hole
        }
    }
}

// A material has one model: the first that it names. That leaves out what changes glTF's base, and keeps
// layers.
TEST(Models, LeaveOutWhatChangesTheBase) {
    materials::Material material(models());
    material.give("EXAMPLE_materials_toon");
    material.give("EXAMPLE_materials_blinn_phong");
    material.give("KHR_materials_clearcoat");
    material.give("KHR_materials_transmission");
    material.give("KHR_materials_anisotropy");
    material["metallicFactor"] = 0.5F;
    material["clearcoatFactor"] = 1.0F;
    material["transmissionFactor"] = 1.0F;
    material["anisotropyStrength"] = 1.0F;
    const materials::FeatureMask key = compiler::makeKey(material, {}, {});
    for (const char* const present : {"blinnPhong", "clearcoat"}) {
        EXPECT_NE(key & models().mask(present), 0U) << present;
    }
    for (const char* const absent : {"toon", "transmission", "anisotropy", "partialMetal"}) {
        EXPECT_EQ(key & models().mask(absent), 0U) << absent;
    }
    const auto reads = [&](const char* object) { return material.reads(models().findObject(object)); };
    EXPECT_TRUE(reads("EXAMPLE_materials_blinn_phong"));
    EXPECT_FALSE(reads("EXAMPLE_materials_toon"));
    EXPECT_FALSE(reads("pbrMetallicRoughness"));
    // Glint's own come first, in the key and in what is read.
    material.give("KHR_materials_pbrSpecularGlossiness");
    EXPECT_EQ(compiler::makeKey(material, {}, {}) & models().ownModels, 0U);
    EXPECT_TRUE(reads("KHR_materials_pbrSpecularGlossiness"));
    EXPECT_FALSE(reads("EXAMPLE_materials_blinn_phong"));
    material.give("KHR_materials_unlit");
    EXPECT_EQ(compiler::makeKey(material, {}, {}) & models().ownModels, 0U);
}

}  // namespace
