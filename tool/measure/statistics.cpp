#include "base/lists.h"

#include <glint/measure/statistics.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

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
    const double mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
    if (values.size() < 2) {
        return {mean, mean, mean};
    }
    const auto squares =
        base::sumOf<double>(values, [&](double value) { return (value - mean) * (value - mean); });
    const double error = std::sqrt(squares / (count - 1.0) / count);
    const double half = studentQuantile(values.size() - 1) * error;
    return {mean, mean - half, mean + half};
}

namespace {

// The normal equations of columns that are scaled to unit length. A small pivot then means that a column is
// nearly a sum of others, whatever its unit.
struct Normal {
    std::size_t size = 0;
    std::vector<double> lengths;   // of the columns; 0 if a column has no effect
    std::vector<double> products;  // size * size, of the unit columns
    std::vector<double> right;     // products of the unit columns with the values
};

Normal makeNormal(std::span<const std::vector<double>> rows, std::span<const double> values,
                  std::size_t unknowns) {
    Normal normal{unknowns, std::vector<double>(unknowns), std::vector<double>(unknowns * unknowns),
                  std::vector<double>(unknowns)};
    for (std::size_t i = 0; i < unknowns; ++i) {
        normal.lengths[i] = std::sqrt(
            base::sumOf<double>(rows, [i](const std::vector<double>& row) { return row[i] * row[i]; }));
    }
    for (std::size_t i = 0; i < unknowns; ++i) {
        for (std::size_t r = 0; r < rows.size() && normal.lengths[i] > 0.0; ++r) {
            const double unit = rows[r][i] / normal.lengths[i];
            normal.right[i] += unit * values[r];
            for (std::size_t j = 0; j < unknowns; ++j) {
                normal.products[i * unknowns + j] +=
                    normal.lengths[j] > 0.0 ? unit * rows[r][j] / normal.lengths[j] : 0.0;
            }
        }
    }
    return normal;
}

// Solves the subset's equations by Cholesky decomposition, for unknowns of unit columns in the order of
// `subset`. Returns nothing if there is no unique solution, or if an unknown is negative.
std::optional<std::vector<double>> solveSubset(const Normal& normal, std::span<const std::size_t> subset) {
    // A bound of the squared length that remains of a column after projection onto those before it. Below
    // this, rounding would decide about its unknown.
    constexpr double kLeastPivot = 1e-9;
    const std::size_t n = subset.size();
    std::vector<double> lower(n * n);
    std::vector<double> x(n);
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j <= i; ++j) {
            double sum = normal.products[subset[i] * normal.size + subset[j]];
            for (std::size_t k = 0; k < j; ++k) {
                sum -= lower[i * n + k] * lower[j * n + k];
            }
            if (i != j) {
                lower[i * n + j] = sum / lower[j * n + j];
            } else if (sum < kLeastPivot) {
                return std::nullopt;
            } else {
                lower[i * n + i] = std::sqrt(sum);
            }
        }
        double sum = normal.right[subset[i]];
        for (std::size_t k = 0; k < i; ++k) {
            sum -= lower[i * n + k] * x[k];
        }
        x[i] = sum / lower[i * n + i];
    }
    for (std::size_t i = n; i-- > 0;) {
        for (std::size_t k = i + 1; k < n; ++k) {
            x[i] -= lower[k * n + i] * x[k];
        }
        x[i] /= lower[i * n + i];
        if (!(x[i] >= 0.0)) {
            return std::nullopt;
        }
    }
    return x;
}

}  // namespace

std::optional<std::vector<double>> nonNegativeLeastSquares(std::span<const std::vector<double>> rows,
                                                           std::span<const double> values,
                                                           std::size_t unknowns) {
    if (rows.empty() || unknowns > kMostUnknowns) {
        return std::nullopt;
    }
    const Normal normal = makeNormal(rows, values, unknowns);
    std::vector<double> best(unknowns);
    // For a solved subset, |A x - b|^2 is |b|^2 minus the product of its solution with the right side.
    double most = 0.0;
    for (std::uint32_t mask = 1; mask < std::uint32_t{1} << unknowns; ++mask) {
        std::vector<std::size_t> subset;
        for (std::size_t i = 0; i < unknowns; ++i) {
            if ((mask >> i & 1U) != 0 && normal.lengths[i] > 0.0) {
                subset.push_back(i);
            }
        }
        const std::optional<std::vector<double>> x = solveSubset(normal, subset);
        if (!x) {
            continue;
        }
        double explained = 0.0;
        for (std::size_t i = 0; i < subset.size(); ++i) {
            explained += (*x)[i] * normal.right[subset[i]];
        }
        if (explained > most) {
            most = explained;
            std::ranges::fill(best, 0.0);
            for (std::size_t i = 0; i < subset.size(); ++i) {
                best[subset[i]] = (*x)[i] / normal.lengths[subset[i]];
            }
        }
    }
    return best;
}

}  // namespace glint::measure
