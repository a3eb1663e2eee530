// Evaluates a handful of repeated measurements, without assuming how they are distributed.
#pragma once

#include <span>

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

}  // namespace glint::measure
