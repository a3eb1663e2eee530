// A hierarchy over the lights of a scene, by which shaders choose one (hit/light_tree.glsl).
#pragma once

#include "interop/lights.h"

#include <cstdint>
#include <span>
#include <vector>

namespace glint {

// The nodes of the tree in depth-first order, so that a node's first child follows it. After them comes a
// leaf for each light without bounds, which is a directional one.
struct LightTree {
    std::vector<gpu::LightNode> nodes;
    std::uint32_t treeNodes = 0;  // 0, or 2 n - 1 for n lights with bounds
    std::uint32_t unbounded = 0;
};

// Builds the tree over lights that have bounds. Each split is the best of 12 bins in each axis, by the
// surface area orientation heuristic: Conty Estevez and Kulla, "Importance Sampling of Many Lights with
// Adaptive Tree Splitting" (2018), equation 1. Large trees are built by several threads. The result depends
// on the lights alone. Takes O(n log n) time, unless the lights are spaced very unevenly.
LightTree buildLightTree(std::span<const gpu::LightRecord> lights);

// Gives the nodes the bounds of lights that moved or changed, and keeps their order. `lights` are as many as
// at the build and have the same types. Takes O(n) time.
void refitLightTree(LightTree& tree, std::span<const gpu::LightRecord> lights);

}  // namespace glint
