// Finds the meshes of a scene that change shape.
#pragma once

#include "gltf/scene.h"

#include <algorithm>

namespace glint::compiler {

// Returns whether the node draws a mesh whose vertices follow a skin or morph targets.
inline bool isDeformed(const gltf::Scene& scene, const gltf::Node& node) {
    if (node.mesh < 0) {
        return false;
    }
    const gltf::Mesh& mesh = scene.meshes[static_cast<std::size_t>(node.mesh)];
    return std::ranges::any_of(mesh.primitives, [&](const gltf::Primitive& primitive) {
        return !primitive.targets.empty() || (node.skin >= 0 && primitive.influences.count > 0);
    });
}

// Returns whether any node of the scene does. Its package then has the deforming pass.
inline bool hasDeformedMesh(const gltf::Scene& scene) {
    return std::ranges::any_of(scene.nodes, [&](const gltf::Node& node) { return isDeformed(scene, node); });
}

}  // namespace glint::compiler
