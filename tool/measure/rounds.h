// The order in which a bench measures configurations, round by round.
#pragma once

#include <chrono>
#include <cstddef>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

namespace glint::measure {

// The time for which a GPU renders before a round, and before each measured time. Its clocks fall while the
// host works between rounds, and take a while to rise again.
inline constexpr std::chrono::milliseconds kRoundWarmUp{250};
inline constexpr std::chrono::milliseconds kWarmUp{10};

// Returns a permutation of [0, count), the order of a round, so that no configuration always follows the same
// other one. The result depends only on the state of `random`, with every standard library.
inline std::vector<std::size_t> shuffled(std::size_t count, std::mt19937_64& random) {
    // The shuffle of Fisher and Yates, because std::shuffle differs between libraries.
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    for (std::size_t i = count; i > 1; --i) {
        std::swap(order[i - 1], order[random() % i]);
    }
    return order;
}

}  // namespace glint::measure
