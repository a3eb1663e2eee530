// Squares of equal area on the sphere of directions, and their refinement.
#pragma once

#include <array>
#include <cstdint>

namespace glint::measure {

using Direction = std::array<double, 3>;

// A square of a hemisphere at one level of a quadtree. All squares of a level have the same solid angle. The
// edges of the two roots are the horizon.
struct HemisphereCell {
    bool lower = false;
    std::uint32_t level = 0;
    std::uint32_t x = 0;  // below 2^level
    std::uint32_t y = 0;

    HemisphereCell child(std::uint32_t number) const {
        return {lower, level + 1, 2 * x + number % 2, 2 * y + number / 2};
    }
    double solidAngle() const;
    // The direction at (u, v) in [0, 1]² of the square.
    Direction at(double u, double v) const;
    // A number that sorts cells along a curve that stays near itself: the Morton order of their corners.
    std::uint64_t place() const;
};

inline constexpr std::uint32_t kDeepestLevel = 17;

// The place of a direction: the cell of kDeepestLevel that has it.
HemisphereCell cellOf(const Direction& direction);
// Returns whether `cell` is `outer` or within it.
bool liesWithin(const HemisphereCell& cell, const HemisphereCell& outer);

}  // namespace glint::measure
