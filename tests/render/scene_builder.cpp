#include "render/scene_builder.h"

#include <cmath>
#include <numbers>

namespace glint::testing {

namespace {

gltf::Float3 add(gltf::Float3 a, gltf::Float3 b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

gltf::Float3 normalizedCross(gltf::Float3 a, gltf::Float3 b) {
    const gltf::Float3 c{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    const float length = std::sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]);
    return {c[0] / length, c[1] / length, c[2] / length};
}

}  // namespace

gltf::Scene emptyScene() {
    gltf::Scene scene;
    scene.path = "made-by-hand.gltf";
    return scene;
}

gltf::Scene sceneWithCamera() {
    gltf::Scene scene = emptyScene();
    addCamera(scene);
    return scene;
}

int addMaterial(gltf::Scene& scene, const materials::Material& material) {
    scene.materials.push_back(material);
    return static_cast<int>(scene.materials.size()) - 1;
}

materials::Material unlitMaterial(gltf::Float3 color) {
    materials::Material material;
    material.give("KHR_materials_unlit");
    material["baseColorFactor"] = {color[0], color[1], color[2], 1.0F};
    return material;
}

materials::Material paint(gltf::Float3 color, float roughness) {
    materials::Material material;
    material["baseColorFactor"] = {color[0], color[1], color[2], 1.0F};
    material["metallicFactor"] = 0.0F;
    material["roughnessFactor"] = roughness;
    return material;
}

materials::Material mirrorMaterial() {
    materials::Material material;
    material["roughnessFactor"] = 0.0F;
    return material;
}

gltf::Primitive makeQuad(int material, gltf::Float3 corner, gltf::Float3 right, gltf::Float3 up) {
    gltf::Primitive quad;
    quad.pointer = "/meshes/0/primitives/0";
    quad.material = material;
    quad.positions = {corner, add(corner, right), add(add(corner, right), up), add(corner, up)};
    quad.normals.assign(4, normalizedCross(right, up));
    quad.texCoords0 = {{0.0F, 1.0F}, {1.0F, 1.0F}, {1.0F, 0.0F}, {0.0F, 0.0F}};
    quad.indices = {0, 1, 2, 0, 2, 3};
    return quad;
}

int addMesh(gltf::Scene& scene, gltf::Primitive primitive) {
    gltf::Mesh mesh;
    mesh.primitives.push_back(std::move(primitive));
    scene.meshes.push_back(std::move(mesh));
    return static_cast<int>(scene.meshes.size()) - 1;
}

void addInstance(gltf::Scene& scene, int mesh, const gltf::Matrix4& world) {
    gltf::Node node;
    node.mesh = mesh;
    node.world = world;
    scene.nodes.push_back(std::move(node));
}

void addInstance(gltf::Scene& scene, int mesh) {
    addInstance(scene, mesh, scaling(1.0, 1.0, 1.0));
}

void addQuad(gltf::Scene& scene, int material, gltf::Float3 corner, gltf::Float3 right, gltf::Float3 up) {
    addInstance(scene, addMesh(scene, makeQuad(material, corner, right, up)));
}

void addQuad(gltf::Scene& scene, const materials::Material& material, gltf::Float3 corner, gltf::Float3 right,
             gltf::Float3 up) {
    addQuad(scene, addMaterial(scene, material), corner, right, up);
}

gltf::Matrix4 scaling(double x, double y, double z) {
    gltf::Matrix4 matrix{};
    matrix[0] = x;
    matrix[5] = y;
    matrix[10] = z;
    matrix[15] = 1.0;
    return matrix;
}

int addTexture(gltf::Scene& scene, int width, int height, std::vector<std::uint8_t> rgba8) {
    gltf::Sampler sampler;
    sampler.magnification = gltf::Filter::Nearest;
    sampler.minification = gltf::Filter::Nearest;
    sampler.mipmapped = false;
    scene.samplers.push_back(sampler);
    gltf::Image image;
    image.name = "made by hand";
    image.width = width;
    image.height = height;
    image.pixels = std::move(rgba8);
    scene.images.push_back(std::move(image));
    scene.textures.push_back(
        {static_cast<int>(scene.images.size()) - 1, static_cast<int>(scene.samplers.size()) - 1});
    return static_cast<int>(scene.textures.size()) - 1;
}

void addCamera(gltf::Scene& scene) {
    gltf::Camera camera;
    camera.yfov = std::numbers::pi / 2.0;
    camera.world = scaling(1.0, 1.0, 1.0);
    scene.cameras.push_back(camera);
}

void addDirectionalLight(gltf::Scene& scene, gltf::Float3 direction, float lux) {
    gltf::Light light;
    light.direction = direction;
    light.intensity = lux;
    scene.lights.push_back(light);
}

}  // namespace glint::testing
