// Evaluates a handful of repeated measurements, without assuming how they are distributed, and fits constants
// to measurements.
#pragma once

#include "base/fields_fwd.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace glint::measure {

// The two-sided confidence of all intervals in this file.
inline constexpr double kConfidence = 0.95;

// Summarises repeated measurements of one thing, in their unit.
struct Interval {
    double median = 0.0;
    // The confidence interval of the median: the innermost pair of order statistics that contains it with at
    // least kConfidence, whatever the distribution (binomial with p = 1/2; David and Nagaraja, Order
    // Statistics, 3rd edition, 7.1). With fewer than six measurements no pair does, and the interval is the
    // whole range.
    double low = 0.0;
    double high = 0.0;
    // The quartiles, linear between order statistics (type 7 of Hyndman and Fan 1996).
    double q1 = 0.0;
    double q3 = 0.0;
};
base::Fields fieldsOf(const Interval*);

// Requires at least one value; all must be finite.
Interval intervalOf(std::span<const double> values);

// Returns whether two intervals have a value in common.
bool overlap(const Interval& a, const Interval& b);

// Returns whether the interval of ratios contains 1, which means no change. For differences, `nothing` is 0.
bool isTie(const Interval& interval, double nothing = 1.0);

// A mean with the confidence interval of Student's t, for measurements that are themselves means of many
// things.
struct MeanInterval {
    double mean = 0.0;
    double low = 0.0;
    double high = 0.0;
};
// With fewer than two values the interval has no width.
MeanInterval meanOf(std::span<const double> values);

// --- Non-negative least squares for a few unknowns ---

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
