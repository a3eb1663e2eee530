// Non-negative least squares for a handful of unknowns.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace glint::bench {

// The most unknowns that nonNegativeLeastSquares() takes: it looks at every subset of them.
inline constexpr std::size_t kMostUnknowns = 12;

// The x that minimises |A x - b| with no x below zero; 0 for columns that bring nothing. `rows`: of A, each
// as long as `unknowns`, all finite; `values`: b, as long as `rows`. Nothing if there are no rows, or more
// unknowns than kMostUnknowns.
//
// Some subset of the unknowns is above zero at the minimum, and those alone solve the plain least squares of
// their columns (the conditions of Karush, Kuhn and Tucker; Lawson and Hanson, Solving Least Squares
// Problems, 1974, chapter 23, walk from subset to subset). Of so few the best of all subsets is found by
// trying each: no tolerance decides when to stop.
std::optional<std::vector<double>> nonNegativeLeastSquares(std::span<const std::vector<double>> rows,
                                                           std::span<const double> values,
                                                           std::size_t unknowns);

}  // namespace glint::bench
