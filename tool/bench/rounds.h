// How a bench goes through what it compares, round by round.
#pragma once

#include <chrono>
#include <cstddef>
#include <random>
#include <vector>

namespace glint::bench {

// How long a GPU renders before a round, and before each time that counts: its clocks fall while the host
// works between rounds, and take a while to come up.
inline constexpr std::chrono::milliseconds kRoundWarmUp{250};
inline constexpr std::chrono::milliseconds kWarmUp{10};

// A permutation of [0, count): the order of a round, in which nothing is always measured behind the same
// other thing. The same for the same state of `random` with every standard library.
std::vector<std::size_t> shuffled(std::size_t count, std::mt19937_64& random);

}  // namespace glint::bench
