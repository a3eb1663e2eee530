// When an acceleration structure that moved is refitted, and when it is built anew. docs/movement.md has the
// measurements.
#pragma once

#include "motion_bounds.h"

#include <cstdint>
#include <span>
#include <vector>

namespace glint {

enum class BuildAction : std::uint8_t { Keep, Refit, Build };

// A refit keeps the tree of the last build: what was near then is thought near now. Boxes don't show every
// way in which that ends, so that a build comes at least this often: its cost is spread over as many frames.
inline constexpr std::uint32_t kMaxRefits = 32;

// Nodes of a mesh that has grown overlap more, and the time of rays goes with their surface: up to this ratio
// of the surface of the mesh's box to that at the build, refits are taken to cost rays less than a build
// costs.
inline constexpr double kMaxGrowth = 2.0;

// How a bottom level stands to its last build.
struct BlasHistory {
    std::uint32_t refits = 0;
    double surface = 0.0;  // of the box at the build

    // `deformed`: whether its vertices have changed since the last call.
    BuildAction next(bool deformed, double surfaceNow) const;
    void apply(BuildAction action, double surfaceNow);
};

// How the top level stands to its last build.
struct TlasHistory {
    std::uint32_t updates = 0;
    std::vector<Box> boxes;  // of the instances at the build

    // Built anew where an instance has gone farther than its box was long: until then no node above it has
    // grown by more than its own size. `moved`: whether an instance or a bottom level has changed.
    BuildAction next(bool moved, std::span<const Box> now) const;
    void apply(BuildAction action, std::span<const Box> now);
};

}  // namespace glint
