// Non-negative least squares for a few unknowns.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace glint::measure {

// The most unknowns that nonNegativeLeastSquares() takes, because it tries every subset of them.
inline constexpr std::size_t kMostUnknowns = 12;

// Returns the x that minimises |A x - b| with no x below zero; x is 0 for columns without effect. `rows` are
// those of A, each as long as `unknowns`, all finite; `values` is b, as long as `rows`. Returns nothing if
// there are no rows, or more unknowns than kMostUnknowns.
//
// At the minimum some subset of the unknowns is above zero, and those alone solve the plain least squares of
// their columns (the conditions of Karush, Kuhn and Tucker). Lawson and Hanson, Solving Least Squares
// Problems, 1974, chapter 23, walk from subset to subset. For so few unknowns it tries each subset and takes
// the best, so no tolerance decides when to stop.
std::optional<std::vector<double>> nonNegativeLeastSquares(std::span<const std::vector<double>> rows,
                                                           std::span<const double> values,
                                                           std::size_t unknowns);

}  // namespace glint::measure
