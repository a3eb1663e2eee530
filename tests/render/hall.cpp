#include "render/hall.h"

#include "render/pixel_test.h"
#include "render/scene_builder.h"

#include <utility>
#include <vector>

namespace glint::testing {
namespace {

materials::Material coatedMaterial(gltf::Float3 color) {
    materials::Material material = paint(color, 0.6F);
    material.give("KHR_materials_clearcoat");
    material["clearcoatFactor"] = 1.0F;
    material["clearcoatRoughnessFactor"] = 0.1F;
    return material;
}

// Returns a chequerboard of holes.
materials::Material fenceMaterial(gltf::Scene& scene) {
    materials::Material material = paint({0.9F, 0.8F, 0.3F}, 0.4F);
    material.alphaMode = materials::AlphaMode::Mask;
    material.doubleSided = true;
    std::vector<std::uint8_t> texels;
    for (int i = 0; i < 64; ++i) {
        const bool solid = (i / 8 + i) % 2 == 0;
        texels.insert(texels.end(), {255, 255, 255, solid ? std::uint8_t{255} : std::uint8_t{0}});
    }
    material.texture("baseColorTexture").texture = addTexture(scene, 8, 8, std::move(texels));
    return material;
}

}  // namespace

gltf::Scene hallScene() {
    gltf::Scene scene = sceneWithCamera();
    const int fence = addMaterial(scene, fenceMaterial(scene));
    const int coated = addMaterial(scene, coatedMaterial(kRed));
    const int glossy = addMaterial(scene, paint(kGreen, 0.3F));
    const int unlit = addMaterial(scene, unlitMaterial(kBlue));
    addQuad(scene, mirrorMaterial(), {-4, -1, 0}, {8, 0, 0}, {0, 0, -8});
    gltf::Mesh wall;
    wall.primitives = {makeQuad(coated, {-4, -0.9F, -5}, {3, 0, 0}, {0, 4, 0}),
                       makeQuad(glossy, {-1, -0.9F, -5}, {2, 0, 0}, {0, 4, 0}),
                       makeQuad(unlit, {1, -0.9F, -5}, {2, 0, 0}, {0, 4, 0}),
                       makeQuad(fence, {-1, -0.9F, -3}, {2, 0, 0}, {0, 1.5F, 0})};
    scene.meshes.push_back(wall);
    addInstance(scene, static_cast<int>(scene.meshes.size()) - 1);
    // A second, mirrored instance stands with its fence in front of the walls of the first.
    addInstance(scene, static_cast<int>(scene.meshes.size()) - 1, scaling(-1.2, 0.9, 1.1));
    addDirectionalLight(scene, {0.0F, -0.6F, -0.8F}, 2.0F);
    gltf::Light lamp;
    lamp.type = gltf::LightType::Point;
    lamp.position = {0.5F, 1.5F, -1.0F};
    lamp.intensity = 9.0F;
    scene.lights.push_back(lamp);
    lamp.type = gltf::LightType::Spot;
    lamp.position = {-2.0F, 1.0F, -1.0F};
    lamp.direction = {0.0F, 0.0F, -1.0F};
    scene.lights.push_back(lamp);
    return scene;
}

}  // namespace glint::testing
