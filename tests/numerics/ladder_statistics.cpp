#include "ladder_statistics.h"

#include "support/quantile.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace glint::numerics {
namespace {

// Returns how many of the smallest, and of the largest, values can be left out so that the interval of the
// rest contains the population's median with a chance of 95 %. It is the largest number for which a binomial
// with that many trials and probability one half has at most 5 % in both tails. Returns 0 if there are too
// few values.
std::size_t outside(std::size_t count) {
    constexpr double kTails = 0.05;
    double term = std::exp2(-static_cast<double>(count));
    double tail = term;
    std::size_t cut = 0;
    while (cut + 1 < count / 2) {
        term *= static_cast<double>(count - cut) / static_cast<double>(cut + 1);
        if (2.0 * (tail + term) > kTails) {
            break;
        }
        tail += term;
        ++cut;
    }
    return cut;
}

}  // namespace

Spread spreadOf(std::vector<double> values) {
    std::ranges::sort(values);
    const std::size_t cut = outside(values.size());
    return {test::quantile(values, 0.5), values[cut], values[values.size() - 1 - cut],
            test::quantile(values, 0.25), test::quantile(values, 0.75)};
}

}  // namespace glint::numerics
