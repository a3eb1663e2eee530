// Integrates lobes over all directions by squares that are split where a lobe is sharp, and compares samples
// with the squares' shares. It uses only a lobe's values and samples.
#pragma once

#include <glint/result.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

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

// The values of one lobe for one direction.
struct LobeValues {
    double density = 0.0;
    std::array<double, 3> reflected{};  // of the lobe, times the cosine
    std::array<double, 3> whole{};      // of the whole BSDF, times the cosine
};

// One direction at which one of the lobes is wanted.
struct LobeQuery {
    std::size_t lobe = 0;
    Direction direction{};
};
using LobeFunction = std::function<Result<std::vector<LobeValues>>(std::span<const LobeQuery>)>;

struct LobeIntegrals {
    double density = 0.0;
    std::array<double, 3> reflected{};
    std::array<double, 3> whole{};
    // The sum of the changes by the last splits: an upper estimate of the errors.
    double densityError = 0.0;
    double wholeError = 0.0;
    double lost = 0.0;  // share of the samples that have no direction
    // The probability of a deviation at least as large as this one, if samples follow the density.
    double significance = 1.0;
    std::uint64_t evaluations = 0;
};

// `samples` has the sampled directions of each lobe, (0, 0, 0) where there is none. Lobes without samples are
// integrated all the same. Has the errors of `function`.
Result<std::vector<LobeIntegrals>> integrateLobes(std::span<const std::vector<Direction>> samples,
                                                  const LobeFunction& function);

// The probability that chi-square with so many degrees of freedom is at least `statistic`.
double chiSquareTail(double statistic, double freedom);

}  // namespace glint::measure
