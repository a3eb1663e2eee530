#include "bench/rounds.h"

#include <numeric>
#include <utility>

namespace glint::bench {

// The shuffle of Fisher and Yates, because std::shuffle differs between libraries.
std::vector<std::size_t> shuffled(std::size_t count, std::mt19937_64& random) {
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    for (std::size_t i = count; i > 1; --i) {
        std::swap(order[i - 1], order[random() % i]);
    }
    return order;
}

}  // namespace glint::bench
