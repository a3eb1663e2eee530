#include "bench/advice.h"

namespace glint::bench {

namespace {

bool isWithin(const Offer& offer, const Demand& demand) {
    return (!demand.time || offer.time.high <= *demand.time) &&
           (!demand.error || offer.error.high <= *demand.error);
}

}  // namespace

std::optional<std::size_t> advise(std::span<const Offer> offers, const Demand& demand) {
    const bool wantsError = demand.time.has_value();
    const auto first = [wantsError](const Offer& offer) -> const Interval& {
        return wantsError ? offer.error : offer.time;
    };
    const auto second = [wantsError](const Offer& offer) -> const Interval& {
        return wantsError ? offer.time : offer.error;
    };
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < offers.size(); ++i) {
        if (isWithin(offers[i], demand) && (!best || first(offers[i]).median < first(offers[*best]).median)) {
            best = i;
        }
    }
    if (!best) {
        return best;
    }
    std::size_t chosen = *best;
    for (std::size_t i = 0; i < offers.size(); ++i) {
        const bool isTied = isWithin(offers[i], demand) && overlap(first(offers[i]), first(offers[*best]));
        if (isTied && second(offers[i]).median < second(offers[chosen]).median) {
            chosen = i;
        }
    }
    return chosen;
}

}  // namespace glint::bench
