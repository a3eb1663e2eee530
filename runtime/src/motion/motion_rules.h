// The rules for when an acceleration structure that moved is refitted and when it is built anew.
// docs/movement.md has the measurements.
#pragma once

#include "motion/motion_bounds.h"

#include <cstdint>
#include <span>
#include <vector>

namespace glint {

enum class BuildAction : std::uint8_t { Keep, Refit, Build };

// A refit keeps the tree of the last build, which grouped the triangles that were near each other at that
// time. Boxes don't show every way in which such a tree gets bad, so a build happens at least this often. Its
// cost is spread over as many frames.
inline constexpr std::uint32_t kMaxRefits = 32;

// Nodes of a mesh that has grown overlap more, and the time of rays grows with their surface. The limit is
// the ratio of the surface of the mesh's box to that at the build. Below it, refits are assumed to cost rays
// less time than a build takes.
inline constexpr double kMaxGrowth = 2.0;

// The changes of a BLAS since its last build.
struct BlasHistory {
    std::uint32_t refits = 0;
    double surface = 0.0;  // surface of the box at the build

    // `deformed` says whether the vertices have changed since the last call.
    BuildAction next(bool deformed, double surfaceNow) const;
    void apply(BuildAction action, double surfaceNow);
};

// The changes of the TLAS since its last build.
struct TlasHistory {
    std::uint32_t updates = 0;
    std::vector<Box> boxes;  // boxes of the instances at the build

    // The TLAS is built anew if an instance has moved farther than its box was long. Until then no node above
    // the instance has grown by more than the instance's own size. `moved` says whether an instance or a BLAS
    // has changed.
    BuildAction next(bool moved, std::span<const Box> now) const;
    void apply(BuildAction action, std::span<const Box> now);
};

}  // namespace glint
