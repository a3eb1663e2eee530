// Tests what packs add beside lobes: attributes of vertices, a time, coordinates and opacity. Every strategy,
// tracer and merge policy shows them alike.
#include "base/files.h"
#include "materials/declarations.h"
#include "render/pixel_test.h"
#include "render/ways.h"
#include "support/temporary_folder.h"

#include <glint/internal/package_modules.h>
#include <glint/session/session.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

namespace {

using namespace glint;
using namespace glint::testing;
namespace fs = std::filesystem;

// A pack of four features: "tint" emits an attribute of the vertices, "clock" the time of the frame, "half"
// cuts away what is right of x = 0, and "shift" moves coordinates by half a texture.
const materials::MaterialModel& stagesModel() {
    static const test::TemporaryFolder folder;
    static const Result<const materials::MaterialModel*> model = [&] {
        const struct {
            const char* name;
            const char* text;
        } files[] = {
            {"tint.json", R"({
                "name": "tint", "stage": "emission", "extension": "TEST_tint", "glsl": { "emission": "tint.glsl" },
                "attributes": [{ "name": "tintColor", "at": "_TINT", "type": "color" },
                               { "name": "tintScale", "at": "_SCALE", "type": "float", "default": 2 }]
            })"},
            {"tint.glsl",
             "#include \"hit/surface_values.glsl\"\n"
             "void tintEmission(Hit hit, Features features, inout vec3 emitted) {\n"
             "    emitted += hit.attributes.tintScale * hit.attributes.tintColor;\n}\n"},
            {"clock.json", R"({
                "name": "clock", "stage": "emission", "extension": "TEST_clock", "glsl": { "emission": "clock.glsl" }
            })"},
            {"clock.glsl",
             "#include \"hit/surface_values.glsl\"\n"
             "void clockEmission(Hit hit, Features features, inout vec3 emitted) {\n"
             "    emitted += vec3(frameTime());\n}\n"},
            {"half.json", R"({
                "name": "half", "stage": "opacity", "extension": "TEST_half", "glsl": { "opacity": "half.glsl" },
                "attributes": [{ "name": "halfPlace", "at": "_PLACE", "type": "float", "default": 0 }]
            })"},
            {"half.glsl",
             "#include \"hit/surface_point.glsl\"\n"
             "void halfOpacity(SurfacePoint point, Features features, inout float alpha) {\n"
             "    alpha = point.position.x > point.attributes.halfPlace ? 0.0 : alpha;\n}\n"},
            {"shift.json", R"({
                "name": "shift", "stage": "coordinates", "extension": "TEST_shift",
                "glsl": { "coordinates": "shift.glsl" }
            })"},
            {"shift.glsl",
             "#include \"hit/surface_point.glsl\"\n"
             "void shiftCoordinates(inout SurfacePoint point, Features features) {\n"
             "    point.texCoords[0].x += 0.5;\n}\n"},
        };
        for (const auto& file : files) {
            EXPECT_TRUE(base::writeFile(folder.path() / file.name, std::string_view(file.text)));
        }
        return materials::loadMaterialModel(std::vector{folder.path().string()});
    }();
    EXPECT_TRUE(model) << toString(model.error());
    return **model;
}

materials::Material blackWith(const char* extension) {
    materials::Material material(stagesModel());
    material["baseColorFactor"] = {0, 0, 0, 1};
    material["metallicFactor"] = 0.0F;
    material.give("KHR_materials_specular");
    material["specularFactor"] = 0.0F;
    material.give(extension);
    return material;
}

// A quad whose colour changes along a diagonal; in its middle it is (0.5, 0.25, 0.5).
gltf::Primitive tintedQuad(int material, gltf::Float3 corner, gltf::Float3 right, gltf::Float3 up) {
    gltf::Primitive quad = makeQuad(material, corner, right, up);
    quad.attributes.push_back(
        {"_TINT", 3, {0.6F, 0.2F, 0.5F, 0.5F, 0.25F, 0.5F, 0.4F, 0.3F, 0.5F, 0.5F, 0.25F, 0.5F}});
    return quad;
}

RenderSetup glossySetup(const gltf::Scene& scene) {
    RenderSetup setup = darkSetup(scene, 33);
    setup.frame.maxReflectionRoughness = 1.0F;
    return setup;
}

compiler::CompileSettings separateCases(package::AlphaPolicy alpha = package::AlphaPolicy::Opaque) {
    compiler::CompileSettings settings;
    settings.plan.merge = compiler::MergePolicy::None;
    settings.plan.keys.alpha = alpha;
    return settings;
}

// The camera sees a mirror on the left and the tinted quad on the right. Another tinted quad is behind the
// camera.
TEST(PackStages, AttributesOfVerticesAndTheTimeReachPrimarySurfacesAndHits) {
    gltf::Scene scene = sceneWithCamera();
    const int tinted = addMaterial(scene, blackWith("TEST_tint"));
    const int clock = addMaterial(scene, blackWith("TEST_clock"));
    materials::Material mirror(stagesModel());
    mirror["roughnessFactor"] = 0.0F;
    const int reflecting = addMaterial(scene, mirror);
    addQuad(scene, reflecting, {-2, -0.5F, -2}, {1, 0, 0}, {0, 1, 0});
    addInstance(scene, addMesh(scene, tintedQuad(tinted, {-0.5F, -0.5F, -2}, {1, 0, 0}, {0, 1, 0})));
    addQuad(scene, clock, {1, -0.5F, -2}, {1, 0, 0}, {0, 1, 0});
    // The mirror image of what is at (-4.5, 0, 2) is in the middle of the mirror.
    addInstance(scene, addMesh(scene, tintedQuad(tinted, {-4, -0.5F, 2}, {-1, 0, 0}, {0, 1, 0})));
    // A primitive without the attribute does not have the feature.
    addQuad(scene, tinted, {-0.5F, 1, -2}, {1, 0, 0}, {0, 0.5F, 0});
    RenderSetup setup = glossySetup(scene);
    setup.frame.time = 2.5F;
    const LoadedScene loaded(scene, separateCases());
    const auto dropped =
        std::ranges::find(loaded.compiled().plan.dropped, "tint", &compiler::DroppedFeature::feature);
    ASSERT_NE(dropped, loaded.compiled().plan.dropped.end());
    EXPECT_EQ(dropped->reason, "the primitive has no _TINT");
    ASSERT_EQ(loaded.package().attributes().size(), 2U);
    EXPECT_EQ(loaded.package().string(loaded.package().attributes()[0].name), "_TINT");
    const LinearImage image = loaded.render(package::kStrategyVisibility, setup);
    // The default of _SCALE doubles the colour. A pixel is 1/8 m wide there, so the colour changes within it.
    constexpr gltf::Float3 kMiddle{1.0F, 0.5F, 1.0F};
    expectColor(at(image, 16, 16), kMiddle, 1e-3F, "primary surface");
    expectColor(at(image, 4, 16), kMiddle, 0.1F, "in the mirror");
    expectColor(at(image, 28, 16), {2.5F, 2.5F, 2.5F}, 1e-6F, "time");
    expectColor(at(image, 16, 7), {0, 0, 0}, 1e-6F, "without the attribute");
}

TEST(PackStages, AttributesThatDoNotFitAreErrors) {
    gltf::Scene scene = sceneWithCamera();
    const int tinted = addMaterial(scene, blackWith("TEST_tint"));
    addInstance(scene, addMesh(scene, tintedQuad(tinted, {-1, -1, -2}, {2, 0, 0}, {0, 2, 0})));
    const LoadedScene loaded(scene, separateCases());
    const auto upload = [&](std::vector<gltf::VertexValues> attributes) {
        scene.meshes[0].primitives[0].attributes = std::move(attributes);
        const session::SceneViewData data = session::makeSceneView(scene);
        const Result<std::unique_ptr<GpuScene>> uploaded =
            GpuScene::upload(sharedContext(), loaded.package(), data.view());
        return uploaded ? std::string() : uploaded.error().id;
    };
    EXPECT_EQ(upload({{"_TINT", 3, std::vector<float>(12)}}), "");
    EXPECT_EQ(upload({}), "scene-package");
    EXPECT_EQ(upload({{"_TINT", 3, std::vector<float>(11)}}), "scene-attribute");
    EXPECT_EQ(upload({{"_TINT", 4, std::vector<float>(16)}}), "scene-attribute");
}

// A cut quad before a wall. The light comes from the left, so that the shadow of the part that is left falls
// to the right of it.
gltf::Scene cutScene() {
    gltf::Scene scene = sceneWithCamera();
    materials::Material wall(stagesModel());
    wall["baseColorFactor"] = {1, 1, 1, 1};
    wall["metallicFactor"] = 0.0F;
    addQuad(scene, wall, {-4, -4, -4}, {8, 0, 0}, {0, 8, 0});
    materials::Material cut = blackWith("TEST_half");
    cut.alphaMode = materials::AlphaMode::Mask;
    cut.doubleSided = true;
    addQuad(scene, cut, {-1, -1, -2}, {2, 0, 0}, {0, 2, 0});
    addDirectionalLight(scene, {0.4472136F, 0, -0.8944272F}, 2.0F);
    return scene;
}

TEST(PackStages, OpacityCutsRasterAndShadowsAlike) {
    const gltf::Scene scene = cutScene();
    const LoadedScene loaded(scene, separateCases(package::AlphaPolicy::Tested));
    const LinearImage image = loaded.render(package::kStrategyVisibility, glossySetup(scene));
    // On the wall, x is (column - 16) / 16.5 * 4 metres. The quad covers x from -2 to 0, its shadow 0 to 1.
    expectColor(at(image, 12, 16), {0, 0, 0}, 1e-6F, "the part that is left");
    expectColor(at(image, 18, 16), {0, 0, 0}, 1e-6F, "its shadow");
    EXPECT_GT(at(image, 22, 16)[0], 0.3F) << "light through what is cut away";
    EXPECT_GT(at(image, 4, 16)[0], 0.3F) << "beside the quad";
}

TEST(PackStages, CoordinatesMoveTextures) {
    gltf::Scene scene = sceneWithCamera();
    const int texture = addTexture(scene, 2, 1, {255, 0, 0, 255, 0, 255, 0, 255});
    for (const bool shifts : {false, true}) {
        materials::Material material(stagesModel());
        material.give("KHR_materials_unlit");
        material.texture("baseColorTexture").texture = texture;
        if (shifts) {
            material.give("TEST_shift");
        }
        addQuad(scene, material, {-1, shifts ? -1.0F : 0.0F, -2}, {2, 0, 0}, {0, 1, 0});
    }
    const LoadedScene loaded(scene, separateCases());
    const LinearImage image = loaded.render(package::kStrategyVisibility, glossySetup(scene));
    expectColor(at(image, 12, 13), {1, 0, 0}, 1e-6F, "left");
    expectColor(at(image, 20, 13), {0, 1, 0}, 1e-6F, "right");
    expectColor(at(image, 12, 19), {0, 1, 0}, 1e-6F, "left, shifted");
    expectColor(at(image, 20, 19), {1, 0, 0}, 1e-6F, "right, shifted");
}

// All stages in one picture: a mirror on the floor shows the cut quad, the tinted wall and the time.
gltf::Scene stagesRoom() {
    gltf::Scene scene = cutScene();
    materials::Material floor(stagesModel());
    floor["roughnessFactor"] = 0.0F;
    addQuad(scene, floor, {-4, -1, 0}, {8, 0, 0}, {0, 0, -4});
    const int tinted = addMaterial(scene, blackWith("TEST_tint"));
    addInstance(scene, addMesh(scene, tintedQuad(tinted, {0.5F, 0, -3.5F}, {1, 0, 0}, {0, 1, 0})));
    materials::Material clock = blackWith("TEST_clock");
    const int texture = addTexture(scene, 2, 1, {255, 40, 0, 255, 0, 255, 90, 255});
    clock["baseColorFactor"] = {1, 1, 1, 1};
    clock.texture("baseColorTexture").texture = texture;
    clock.give("TEST_shift");
    addQuad(scene, clock, {-3, -0.5F, -3}, {1, 0, 0}, {0, 1, 0});
    return scene;
}

// The nightly sweep sets GLINT_NIGHTLY and takes all policies.
TEST(PackStages, EveryStrategyTracerAndMergePolicyGivesOneImage) {
    const gltf::Scene scene = stagesRoom();
    RenderSetup setup = glossySetup(scene);
    setup.width = 40;
    setup.height = 24;
    setup.frame.time = 0.25F;
    std::vector<compiler::MergePolicy> policies{compiler::MergePolicy::None, compiler::MergePolicy::All};
    if (std::getenv("GLINT_NIGHTLY") != nullptr) {
        policies.insert(policies.end(), {compiler::MergePolicy::Family, compiler::MergePolicy::Auto});
    }
    LinearImage reference;
    int pictures = 0;
    for (const compiler::MergePolicy merge : policies) {
        compiler::CompileSettings settings = separateCases(package::AlphaPolicy::Tested);
        settings.plan.merge = merge;
        forEachWay(scene, settings, [&](const LoadedScene& loaded, const Way& way) {
            const LinearImage image = loaded.render(optionsOf(way), setup);
            reference = reference.pixels.empty() ? image : reference;
            expectSameImage(image, reference, std::string(nameOf(merge)) + " " + nameOf(way));
            ++pictures;
        });
    }
    EXPECT_GE(pictures, 4 * static_cast<int>(policies.size()));
}

}  // namespace
