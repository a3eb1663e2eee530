// Where the tiles of the ceiling are, and of which case each is.
#pragma once

#include "synthetic/cases_scene.h"

#include <cstddef>
#include <vector>

namespace glint::synthetic {

// Metres: of the camera above the floor, which is at height 0, and of the ceiling.
inline constexpr double kCameraHeight = 1.0;
inline constexpr double kCeilingHeight = 3.0;
// Of the camera, vertical, radians.
inline constexpr double kFieldOfView = 1.0;

// What the camera sees at a distance, from the middle to the edge.
struct Extent {
    double x = 0.0;
    double z = 0.0;
};
Extent viewExtent(double distance, double aspect);

// Parallel to the floor, around the vertical axis.
struct Ceiling {
    Extent extent;             // from the middle to the edge
    int tiles = 0;             // a side
    std::vector<int> cases{};  // row by row, from -z and there from -x

    std::size_t place(int row, int column) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(tiles) +
               static_cast<std::size_t>(column);
    }
    // The case above a point; -1: none.
    int caseAt(double x, double z) const;
};

Ceiling makeCeiling(const CasesOptions& options);

// The share that each case should have, greatest first: 1 in all.
std::vector<double> sharesOf(const CasesOptions& options);

}  // namespace glint::synthetic
