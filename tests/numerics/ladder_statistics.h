// Statistics of repeated measurements.
#pragma once

#include <vector>

namespace glint::numerics {

// Requires at least one number.
struct Spread {
    double median = 0.0;
    double low = 0.0;  // 95 % confidence interval of the median, by order statistics
    double high = 0.0;
    double q1 = 0.0;
    double q3 = 0.0;
};

Spread spreadOf(std::vector<double> values);

// Returns whether the confidence intervals overlap, so that no difference is shown.
inline bool isTie(const Spread& a, const Spread& b) {
    return a.low <= b.high && b.low <= a.high;
}

}  // namespace glint::numerics
