// A scene at a time of its animations: where every node is, how far every morph target counts, and the values
// of materials, lights and cameras.
#pragma once

#include "gltf/scene.h"

#include <cstddef>
#include <span>
#include <vector>

namespace glint {

struct Pose {
    std::vector<Matrix4> worlds;  // of Scene::nodes, in their order
    // By node: of its morph targets; empty where it has none.
    std::vector<std::vector<double>> weights;
    std::vector<bool> visible;        // by node: KHR_node_visibility of itself alone
    std::vector<Material> materials;  // of Scene::animatedMaterials, in their order
    // Empty where the scene has no restLights or restCameras. Places are those of the nodes.
    std::vector<Light> lights;
    std::vector<Camera> cameras;
};

// As the file places everything.
Pose restPose(const Scene& scene);

// At `time`, seconds from the start of the animations, whose numbers index scene.animations; where two move
// the same property the later one holds. What none of them moves is at rest. Before an animation's first
// keyframe its properties have the values of the first, after its last those of the last: nothing repeats.
Pose poseAt(const Scene& scene, std::span<const std::size_t> animations, double time);

// Puts the nodes, cameras and lights of the scene where the pose has them, and the weights into its nodes.
// Where a node is squashed to nothing, its camera or light keeps the direction that it had.
void applyPose(const Pose& pose, Scene& scene);

// Of each joint of a skin: from the mesh's space to the world (glTF 2.0, section 3.7.3.3).
std::vector<Matrix4> jointMatrices(const Scene& scene, const Skin& skin);

}  // namespace glint
