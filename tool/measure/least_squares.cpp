#include "measure/least_squares.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace glint::measure {

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
        double squares = 0.0;
        for (const std::vector<double>& row : rows) {
            squares += row[i] * row[i];
        }
        normal.lengths[i] = std::sqrt(squares);
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
