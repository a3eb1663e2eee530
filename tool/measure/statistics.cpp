#include <glint/measure/statistics.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace glint::measure {

namespace {

// Returns the sorted value that lies `share` of the way from the least to the greatest.
double quantile(std::span<const double> sorted, double share) {
    const double at = share * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(at);
    const std::size_t above = std::min(below + 1, sorted.size() - 1);
    return sorted[below] + (sorted[above] - sorted[below]) * (at - static_cast<double>(below));
}

// Returns how many of `count` sorted values to leave out at each end, so that the rest still holds the median
// with kConfidence. It is the largest number for which P(Binomial(count, 1/2) < left out + 1) <= (1 -
// kConfidence) / 2.
std::size_t leftOut(std::size_t count) {
    double term = std::pow(0.5, static_cast<double>(count));  // probability that Binomial is 0
    double below = term;
    std::size_t left = 0;
    while (below <= 0.5 * (1.0 - kConfidence)) {
        ++left;
        term *= static_cast<double>(count - left + 1) / static_cast<double>(left);
        below += term;
    }
    return left == 0 ? 0 : left - 1;
}

// Returns the quantile 1 - (1 - kConfidence) / 2 of Student's t. From three degrees on it uses the expansion
// by powers of 1 / degrees of Abramowitz and Stegun 26.7.5, which is accurate to 1 %; below that it has the
// exact values.
double studentQuantile(std::size_t degrees) {
    constexpr double kOneDegree = 12.706205;
    constexpr double kTwoDegrees = 4.302653;
    if (degrees <= 2) {
        return degrees == 2 ? kTwoDegrees : kOneDegree;
    }
    constexpr double kNormal = 1.959963985;
    const double x = kNormal;
    const double v = 1.0 / static_cast<double>(degrees);
    const double x2 = x * x;
    const double g1 = x * (x2 + 1.0) / 4.0;
    const double g2 = x * ((5.0 * x2 + 16.0) * x2 + 3.0) / 96.0;
    const double g3 = x * (((3.0 * x2 + 19.0) * x2 + 17.0) * x2 - 15.0) / 384.0;
    const double g4 = x * ((((79.0 * x2 + 776.0) * x2 + 1482.0) * x2 - 1920.0) * x2 - 945.0) / 92160.0;
    return x + v * (g1 + v * (g2 + v * (g3 + v * g4)));
}

}  // namespace

Interval intervalOf(std::span<const double> values) {
    std::vector<double> sorted(values.begin(), values.end());
    std::ranges::sort(sorted);
    const std::size_t left = leftOut(sorted.size());
    return {quantile(sorted, 0.5), sorted[left], sorted[sorted.size() - 1 - left], quantile(sorted, 0.25),
            quantile(sorted, 0.75)};
}

bool overlap(const Interval& a, const Interval& b) {
    return a.low <= b.high && b.low <= a.high;
}

bool isTie(const Interval& interval, double nothing) {
    return interval.low <= nothing && nothing <= interval.high;
}

MeanInterval meanOf(std::span<const double> values) {
    const auto count = static_cast<double>(values.size());
    double sum = 0.0;
    for (const double value : values) {
        sum += value;
    }
    const double mean = sum / count;
    if (values.size() < 2) {
        return {mean, mean, mean};
    }
    double squares = 0.0;
    for (const double value : values) {
        squares += (value - mean) * (value - mean);
    }
    const double error = std::sqrt(squares / (count - 1.0) / count);
    const double half = studentQuantile(values.size() - 1) * error;
    return {mean, mean - half, mean + half};
}

}  // namespace glint::measure
