// Which of the measured configurations to take, for a budget of time or of error.
#pragma once

#include "bench/statistics.h"

#include <cstddef>
#include <optional>
#include <span>

namespace glint::bench {

// What is known of a configuration.
struct Offer {
    Interval time;
    Interval error;
};

// What is asked for: at least one of them.
struct Demand {
    std::optional<double> time;   // in the unit of the offers
    std::optional<double> error;  // likewise
};

// Nothing where no offer is surely within what is demanded: the upper ends of its intervals are. With a
// budget of time the least error, else the least time. Among those that can't be told from the best (their
// intervals overlap) the one that is better in the other respect.
std::optional<std::size_t> advise(std::span<const Offer> offers, const Demand& demand);

}  // namespace glint::bench
