// Decides which meshes change shape, and computes their vertices at a pose.
#pragma once

#include "gltf/scene.h"

#include <array>
#include <span>
#include <vector>

namespace glint {

// Returns whether the node draws a mesh whose vertices follow a skin or morph targets.
bool isDeformed(const Scene& scene, const Node& node);

// Returns whether any node of the scene does. Its package then has the deforming pass.
bool hasDeformedMesh(const Scene& scene);

// Returns the positions of a primitive in double precision. The differences of the targets are added,
// multiplied by `weights`: one for each target, and 0 for missing ones. The joints then transform the sum if
// the primitive follows any and `joints` is not empty (glTF 2.0, sections 3.7.2.2 and 3.7.3.3).
std::vector<std::array<double, 3>> deformedPositions(const Primitive& primitive,
                                                     std::span<const double> weights,
                                                     std::span<const Matrix4> joints);

}  // namespace glint
