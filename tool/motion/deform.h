// Meshes that change shape: which they are, and their vertices at a pose.
#pragma once

#include "gltf/scene.h"

#include <array>
#include <span>
#include <vector>

namespace glint {

// Whether the node draws a mesh whose vertices follow a skin or morph targets.
bool isDeformed(const Scene& scene, const Node& node);

// Whether a node of the scene does: its package then has the pass that deforms.
bool hasDeformedMesh(const Scene& scene);

// Positions of a primitive in double precision: the targets' differences times `weights`, one a target
// (missing ones are 0), then what the joints make of the sum, if the primitive follows any and `joints` are
// not empty (glTF 2.0, sections 3.7.2.2 and 3.7.3.3).
std::vector<std::array<double, 3>> deformedPositions(const Primitive& primitive,
                                                     std::span<const double> weights,
                                                     std::span<const Matrix4> joints);

}  // namespace glint
