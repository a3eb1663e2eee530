// The places of the ceiling's tiles, and the case of each tile.
#pragma once

#include "synthetic/cases_scene.h"

#include <cstddef>
#include <vector>

namespace glint::synthetic {

// Heights in metres above the floor, which is at height 0: the camera's and the ceiling's.
inline constexpr double kCameraHeight = 1.0;
inline constexpr double kCeilingHeight = 3.0;
// The camera's vertical field of view, in radians.
inline constexpr double kFieldOfView = 1.0;

// The half size of the camera's view at a distance, from the middle to the edge.
struct Extent {
    double x = 0.0;
    double z = 0.0;
};
Extent viewExtent(double distance, double aspect);

// The ceiling. It is parallel to the floor, around the vertical axis.
struct Ceiling {
    Extent extent;             // from the middle to the edge
    int tiles = 0;             // number of tiles a side
    std::vector<int> cases{};  // row by row from -z, and within a row from -x

    std::size_t place(int row, int column) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(tiles) +
               static_cast<std::size_t>(column);
    }
    // Returns the case above a point, or -1 if there is none.
    int caseAt(double x, double z) const;
};

Ceiling makeCeiling(const CasesOptions& options);

// Returns the share that each case should have, largest first. They add up to 1.
std::vector<double> sharesOf(const CasesOptions& options);

}  // namespace glint::synthetic
