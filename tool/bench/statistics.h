// What a handful of repeated measurements says, without assuming how they are distributed.
#pragma once

#include <span>

namespace glint::bench {

// The two-sided confidence of every interval here.
inline constexpr double kConfidence = 0.95;

// Of repeated measurements of one thing, in their unit.
struct Interval {
    double median = 0.0;
    // Confidence interval of the median: the innermost pair of order statistics that holds it with at least
    // kConfidence, whatever the distribution (binomial with p = 1/2; David and Nagaraja, Order Statistics,
    // 3rd edition, 7.1). With fewer than six measurements no pair does: then it is the whole range.
    double low = 0.0;
    double high = 0.0;
    // Quartiles, linear between order statistics (type 7 of Hyndman and Fan 1996).
    double q1 = 0.0;
    double q3 = 0.0;
};

// `values`: at least one, all finite.
Interval intervalOf(std::span<const double> values);

// Whether two intervals have a value in common.
bool overlap(const Interval& a, const Interval& b);

// Whether the interval of ratios (or of differences, with `nothing` 0) has the value that means no change.
bool isTie(const Interval& interval, double nothing = 1.0);

// A mean with the confidence interval of Student's t, for measurements that are means of many things
// themselves.
struct MeanInterval {
    double mean = 0.0;
    double low = 0.0;
    double high = 0.0;
};
// `values`: at least two for an interval that is wider than nothing.
MeanInterval meanOf(std::span<const double> values);

}  // namespace glint::bench
