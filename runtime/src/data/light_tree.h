// A hierarchy over the lights of a scene, by which shaders choose one (light/tree.glsl).
#pragma once

#include "interop/lights.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <numbers>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace glint {

// Directions within an angle of an axis.
struct LightCone {
    glm::dvec3 axis{0.0, 0.0, 1.0};
    double angle = std::numbers::pi;
};

// The properties that the cost of a set of lights depends on.
struct LightExtent {
    glm::dvec3 lower{};
    glm::dvec3 upper{};
    LightCone axes;          // holds the axes of all
    double emission = 0.0;   // the most angle between a light's axis and a direction in which it shines
    double intensity = 0.0;  // sum, candela
    bool isEmpty = true;
};

// The properties of a set of lights.
struct LightBounds : LightExtent {
    glm::dvec3 mean{};      // of the positions, weighted by intensity
    glm::dvec3 variance{};  // of the positions, by axis
    double reach = 0.0;     // metres; infinite if a light has no range
    bool twoSided = false;  // a light shines along its axis and against it
};

// The nodes of the tree in depth-first order, so that a node's first child follows it. After them comes a
// leaf for each light apart from it: directional ones, which have no bounds, and a few others beside
// emitters.
struct LightTree {
    std::vector<gpu::LightNode> nodes;
    std::uint32_t treeNodes = 0;  // 0, or 2 n - 1 for n lights with bounds
    std::uint32_t apart = 0;

    // The start of a refit for a few lights. A refit for all lights makes it.
    struct Refits {
        static constexpr std::uint32_t kNoLeaf = ~0U;
        std::vector<LightBounds> bounds;           // by node
        std::vector<std::uint32_t> parents;        // by node
        std::vector<std::uint32_t> lightLeaves;    // by light; kNoLeaf: apart from the tree
        std::vector<std::uint32_t> emitterLeaves;  // by emitter
    };
    std::optional<Refits> refits;
};

// Bounds of the light of a triangle.
struct EmitterBounds {
    std::array<double, 3> lower{};
    std::array<double, 3> upper{};
    std::array<double, 3> normal{};  // unit vector, on the side that shines; 0 if it may be any
    bool twoSided = false;
    double intensity = 0.0;  // an estimate of that along the normal, candela; 0: the triangle is dark
};

// Builds the tree over lights that have bounds, which their sizes are part of, and are not apart. Each split
// is the best of 12 bins in each axis, by the surface area orientation heuristic: Conty Estevez and Kulla,
// "Importance Sampling of Many Lights with Adaptive Tree Splitting" (2018), equation 1. Large trees are built
// by several threads. The result depends on the lights alone. Where lights are spaced so unevenly that the
// tree would be deeper than gpu::kLightTreeDepth, nodes are halved instead. Takes O(n log n) time. The leaf
// of an emitter has gpu::kLightEmitter in its number. With `keepsDark`, emitters that are dark have leaves,
// too, because they may shine after refitLightTree().
LightTree buildLightTree(std::span<const gpu::LightRecord> lights,
                         std::span<const EmitterBounds> emitters = {}, bool keepsDark = false);

// Gives the nodes the bounds of lights that moved or changed, and keeps their order. `lights` are as many as
// at the build and have the same types. Takes O(n) time.
void refitLightTree(LightTree& tree, std::span<const gpu::LightRecord> lights,
                    std::span<const EmitterBounds> emitters = {});

// The same for lights and emitters that have changed since the last refit, with their numbers. Requires
// LightTree::refits. Returns the nodes that may differ from before. Takes O(k log n) time for k changes.
std::vector<std::uint32_t> refitLightTree(LightTree& tree,
                                          std::span<const std::pair<std::uint32_t, gpu::LightRecord>> lights,
                                          std::span<const std::pair<std::uint32_t, EmitterBounds>> emitters);

}  // namespace glint
