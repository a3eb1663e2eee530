#include "render/moving_scenes.h"

#include "render/scene_builder.h"
#include "scene/deformed.h"

#include <glint/session/scene_view.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace glint::testing {
namespace {

// Adds a mirror below, whose reflections show the content of the TLAS.
void addRoom(gltf::Scene& scene) {
    addCamera(scene);
    addDirectionalLight(scene, {0.0F, -0.6F, -0.8F}, 3.0F);
    const int mirror = addMaterial(scene, mirrorMaterial());
    addQuad(scene, mirror, {-4, -1, -1}, {8, 0, 0}, {0, 0, -8});
}

// Returns a strip of 1 x 2 m with `segments` rows above (0, 0, 0). All its vertices have normals and
// tangents.
gltf::Primitive makeStrip(int material, std::uint32_t segments) {
    gltf::Primitive strip;
    strip.pointer = "/meshes/1/primitives/0";
    strip.material = material;
    for (std::uint32_t row = 0; row <= segments; ++row) {
        const float y = 2.0F * static_cast<float>(row) / static_cast<float>(segments);
        for (const float x : {-0.5F, 0.5F}) {
            strip.positions.push_back({x, y, 0});
        }
        if (row < segments) {
            const std::uint32_t i = 2 * row;
            strip.indices.insert(strip.indices.end(), {i, i + 1, i + 3, i, i + 3, i + 2});
        }
    }
    strip.normals.assign(strip.positions.size(), {0, 0, 1});
    strip.tangents.assign(strip.positions.size(), {1, 0, 0, 1});
    return strip;
}

}  // namespace

gltf::Matrix4 placed(double x, double y, double z, double angle) {
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    return {c, s, 0, 0, -s, c, 0, 0, 0, 0, 1, 0, x, y, z, 1};
}

gltf::Scene rigidScene() {
    gltf::Scene scene = emptyScene();
    addRoom(scene);
    const int red = addMaterial(scene, paint({0.9F, 0.1F, 0.1F}));
    const int quad = addMesh(scene, makeQuad(red, {-0.5F, -0.5F, 0}, {1, 0, 0}, {0, 1, 0}));
    addInstance(scene, quad, placed(-1, 0, -3));
    addInstance(scene, quad, placed(1, 0, -3));
    return scene;
}

gltf::Scene skinnedScene(double angle) {
    gltf::Scene scene = emptyScene();
    addRoom(scene);
    gltf::Primitive strip = makeStrip(addMaterial(scene, paint({0.1F, 0.6F, 0.9F})), 16);
    strip.influences.count = 2;
    for (const gltf::Float3& position : strip.positions) {
        const float up = position[1] / 2.0F;
        strip.influences.joints.insert(strip.influences.joints.end(), {0, 1});
        strip.influences.weights.insert(strip.influences.weights.end(), {1.0F - up, up});
    }
    // The node's own transform has no effect.
    addInstance(scene, addMesh(scene, std::move(strip)), placed(40, 40, 40));
    gltf::Node joint;
    joint.world = placed(0, -0.8, -2.5);
    scene.nodes.push_back(joint);
    joint.world = placed(0, 0.2, -2.5, angle);
    scene.nodes.push_back(joint);
    gltf::Skin skin;
    skin.joints = {2, 3};
    skin.inverseBinds = {placed(0, 0, 0), placed(0, -1, 0)};
    scene.skins.push_back(skin);
    scene.nodes[1].skin = 0;
    return scene;
}

gltf::Scene bakedScene(const gltf::Scene& scene) {
    gltf::Scene baked = scene;
    gltf::Node& node = baked.nodes[1];
    gltf::Primitive& primitive = baked.meshes[static_cast<std::size_t>(node.mesh)].primitives[0];
    const std::vector<gltf::Matrix4> joints =
        node.skin >= 0 ? session::jointMatrices(scene, scene.skins[0]) : std::vector<gltf::Matrix4>();
    const auto positions = session::deformedPositions(primitive, node.weights, joints);
    for (std::size_t i = 0; i < positions.size(); ++i) {
        primitive.positions[i] = {static_cast<float>(positions[i][0]), static_cast<float>(positions[i][1]),
                                  static_cast<float>(positions[i][2])};
    }
    primitive.influences = {};
    primitive.targets.clear();
    node.weights.clear();
    node.world = node.skin >= 0 ? placed(0, 0, 0) : node.world;
    node.skin = -1;
    return baked;
}

gltf::Scene morphedScene(std::vector<double> weights) {
    gltf::Scene scene = emptyScene();
    addRoom(scene);
    gltf::Primitive strip = makeStrip(addMaterial(scene, paint({0.9F, 0.7F, 0.1F})), 8);
    strip.targets.resize(2);
    for (const gltf::Float3& position : strip.positions) {
        strip.targets[0].positions.push_back({0.5F * position[1] * position[1], 0, 0});
        strip.targets[1].positions.push_back({0, -0.25F * position[1], 0.2F});
    }
    addInstance(scene, addMesh(scene, std::move(strip)), placed(0, -0.8, -2.5, 0.1));
    scene.meshes[1].weights = {0.0, 0.0};
    scene.nodes[1].weights = std::move(weights);
    return scene;
}

}  // namespace glint::testing
