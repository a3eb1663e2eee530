// Recommends one of the measured configurations for a budget of time or of error.
#pragma once

#include "bench/statistics.h"

#include <cstddef>
#include <optional>
#include <span>

namespace glint::bench {

// The measured time and error of a configuration.
struct Offer {
    Interval time;
    Interval error;
};

// The user's budget: at least one of the two is set.
struct Demand {
    std::optional<double> time;   // in the unit of the offers
    std::optional<double> error;  // in the unit of the offers
};

// Returns the index of the recommended offer. It returns nothing if no offer is certainly within the budget,
// that is, if no upper end of an interval is. With a budget of time it takes the least error, else the least
// time. Among offers that can't be told from the best (their intervals overlap) it takes the one that is
// better in the other respect.
std::optional<std::size_t> advise(std::span<const Offer> offers, const Demand& demand);

}  // namespace glint::bench
