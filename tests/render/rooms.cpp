#include "render/rooms.h"

#include "render/scene_builder.h"
#include "support/nightly.h"

#include <cmath>
#include <numbers>
#include <utility>

namespace glint::testing {
namespace {

materials::Material metal(gltf::Float3 color, float roughness) {
    materials::Material material = paint(color, roughness);
    material["metallicFactor"] = 1.0F;
    return material;
}

// Returns a texture of two by two texels; 0 means a hole.
int checkers(gltf::Scene& scene, int size, std::uint8_t otherAlpha) {
    std::vector<std::uint8_t> texels;
    for (int i = 0; i < size * size; ++i) {
        const bool odd = (i / size + i) % 2 != 0;
        const std::uint8_t level = odd ? 90 : 255;
        texels.insert(texels.end(), {level, level, 255, odd ? otherAlpha : std::uint8_t{255}});
    }
    return addTexture(scene, size, size, std::move(texels));
}

void addWall(gltf::Scene& scene, const materials::Material& material, gltf::Float3 corner, gltf::Float3 right,
             gltf::Float3 up) {
    addQuad(scene, material, corner, right, up);
}

void addLamp(gltf::Scene& scene, gltf::Float3 position, gltf::Float3 color, float candela) {
    gltf::Light lamp;
    lamp.type = gltf::LightType::Point;
    lamp.position = {position[0], position[1], position[2]};
    lamp.color = color;
    lamp.intensity = candela;
    scene.lights.push_back(lamp);
}

// Adds one of eight vertical strips in front of the camera, each with another material.
void addStrip(gltf::Scene& scene, const materials::Material& material, int strip) {
    constexpr double kPi = std::numbers::pi;
    const auto corner = [](int number) {
        const double angle = kPi * (0.15 + 0.7 * number / 8.0);
        return gltf::Float3{static_cast<float>(-4.0 * std::cos(angle)), -1.0F,
                            static_cast<float>(-4.0 * std::sin(angle))};
    };
    const gltf::Float3 left = corner(strip);
    const gltf::Float3 right = corner(strip + 1);
    addWall(scene, material, left, {right[0] - left[0], 0, right[2] - left[2]}, {0, 3, 0});
}

gltf::Scene roomOf(bool everyLobe) {
    gltf::Scene scene = sceneWithCamera();
    addWall(scene, metal({0.9F, 0.9F, 0.9F}, 0.25F), {-5, -1, 0}, {10, 0, 0}, {0, 0, -5});

    materials::Material textured = paint({1, 1, 1}, 0.8F);
    textured.texture("baseColorTexture").texture = checkers(scene, 8, 255);
    addStrip(scene, textured, 0);
    materials::Material coated = paint({0.7F, 0.05F, 0.05F}, 0.6F);
    coated["clearcoatFactor"] = 1.0F;
    coated["clearcoatRoughnessFactor"] = 0.1F;
    addStrip(scene, coated, 1);
    if (everyLobe) {
        materials::Material cloth = paint({0.2F, 0.2F, 0.5F}, 0.9F);
        cloth["sheenColorFactor"] = {0.8F, 0.6F, 0.4F};
        cloth["sheenRoughnessFactor"] = 0.4F;
        addStrip(scene, cloth, 2);
        materials::Material brushed = metal({0.9F, 0.7F, 0.4F}, 0.4F);
        brushed["anisotropyStrength"] = 0.8F;
        addStrip(scene, brushed, 4);
        materials::Material film = metal({0.5F, 0.5F, 0.5F}, 0.3F);
        film["iridescenceFactor"] = 1.0F;
        addStrip(scene, film, 5);
    }
    addStrip(scene, unlitMaterial({0.1F, 0.8F, 0.3F}), 3);
    materials::Material lamp = paint({0, 0, 0}, 1.0F);
    lamp["emissiveFactor"] = {2.0F, 1.5F, 0.5F};
    addStrip(scene, lamp, 6);
    addStrip(scene, mirrorMaterial(), 7);

    addDirectionalLight(scene, {0.3F, -0.8F, -0.5F}, 2.0F);
    addLamp(scene, {-1.5F, 1.0F, -2.5F}, {1.0F, 0.6F, 0.3F}, 4.0F);
    addLamp(scene, {1.5F, 0.5F, -2.0F}, {0.3F, 0.6F, 1.0F}, 4.0F);
    return scene;
}

}  // namespace

gltf::Scene roomOfMaterials() {
    return roomOf(true);
}

gltf::Scene roomOfFewMaterials() {
    return roomOf(test::nightly());
}

gltf::Scene roomBehindPane() {
    gltf::Scene scene = roomOfFewMaterials();
    materials::Material pane;
    pane["metallicFactor"] = 0.0F;
    pane["roughnessFactor"] = 0.1F;
    pane["transmissionFactor"] = 0.8F;
    pane.doubleSided = true;
    addQuad(scene, pane, {-1.2F, -0.4F, -1.2F}, {1, 0, 0}, {0, 1, 0});
    return scene;
}

gltf::Scene roomWithFence() {
    gltf::Scene scene = sceneWithCamera();
    addWall(scene, mirrorMaterial(), {-3, -2, -4}, {6, 0, 0}, {0, 5, 0});
    addWall(scene, paint({0.6F, 0.6F, 0.6F}, 0.2F), {-3, -1, 1}, {6, 0, 0}, {0, 0, -5});
    materials::Material fence = paint({0.9F, 0.8F, 0.3F}, 0.4F);
    fence.alphaMode = materials::AlphaMode::Mask;
    fence.doubleSided = true;
    fence.texture("baseColorTexture").texture = checkers(scene, 8, 0);
    addWall(scene, fence, {-1.5F, -1, -2}, {1.6F, 0, 0.4F}, {0, 1.8F, 0});
    const int post = addMesh(scene, makeQuad(addMaterial(scene, metal({0.9F, 0.4F, 0.3F}, 0.3F)),
                                             {0.6F, -1, -2.5F}, {0.8F, 0, 0.3F}, {0, 1.5F, 0}));
    addInstance(scene, post);
    addInstance(scene, post, scaling(-1, 1, 1.2));
    materials::Material glass = paint({0.9F, 1.0F, 0.95F}, 0.1F);
    glass["transmissionFactor"] = 0.8F;
    glass.doubleSided = true;
    addWall(scene, glass, {1.2F, -1, -1.5F}, {0.8F, 0, -1.2F}, {0, 1.8F, 0});
    addLamp(scene, {0.2F, 1.5F, -1.0F}, {1, 1, 1}, 6.0F);
    return scene;
}

}  // namespace glint::testing
