// Computes a scene at a time of its animations: the place of every node, the weight of every morph target,
// and the values of materials, lights and cameras. Times are seconds, transforms are column-major and in
// metres. None of these functions fails.
#pragma once

#include "gltf/scene.h"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace glint::scene_view {

struct Pose {
    std::vector<gltf::Matrix4> worlds;  // one for each of Scene::nodes, in their order
    // For each node, the weights of its morph targets; empty if it has none.
    std::vector<std::vector<double>> weights;
    std::vector<bool> visible;                   // for each node, its own KHR_node_visibility
    std::vector<materials::Material> materials;  // one for each of Scene::animatedMaterials, in their order
    // These are empty if the scene has no restLights or restCameras. The nodes give their places.
    std::vector<gltf::Light> lights;
    std::vector<gltf::Camera> cameras;
};

// Returns the pose in which the file places everything.
Pose restPose(const gltf::Scene& scene);

// Returns the pose at `time`, in seconds from the start of the animations. `animations` holds indices into
// scene.animations. If two animations move the same property, the later one wins. Properties that none of
// them moves are at rest. Before an animation's first keyframe its properties have the values of the first,
// and after the last those of the last. Nothing repeats.
Pose poseAt(const gltf::Scene& scene, std::span<const std::size_t> animations, double time);

// Moves the nodes, cameras and lights of the scene to their places in the pose, and copies the weights into
// its nodes. If a node is squashed to nothing, its camera or light keeps its direction.
void applyPose(const Pose& pose, gltf::Scene& scene);

// Returns a matrix for each joint of a skin, from the mesh's space to the world (glTF 2.0, section 3.7.3.3).
std::vector<gltf::Matrix4> jointMatrices(const gltf::Scene& scene, const gltf::Skin& skin);

// Returns the positions of a primitive in double precision. The differences of the targets are added,
// multiplied by `weights`: one for each target, and 0 for missing ones. The joints then transform the sum if
// the primitive follows any and `joints` is not empty (glTF 2.0, sections 3.7.2.2 and 3.7.3.3).
std::vector<std::array<double, 3>> deformedPositions(const gltf::Primitive& primitive,
                                                     std::span<const double> weights,
                                                     std::span<const gltf::Matrix4> joints);

}  // namespace glint::scene_view
