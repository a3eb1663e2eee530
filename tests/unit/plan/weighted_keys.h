// Keys with their shares of the hits, for tests of planning.
#pragma once

#include "plan/merge.h"

#include <map>
#include <vector>

namespace glint::testing {

// Returns keys in ascending order of masks, as planning has them. Shares add up to 1.
inline std::vector<compiler::WeightedKey> toKeys(const std::map<materials::FeatureMask, double>& weights) {
    double sum = 0.0;
    for (const auto& [mask, weight] : weights) {
        sum += weight;
    }
    std::vector<compiler::WeightedKey> keys;
    keys.reserve(weights.size());
    for (const auto& [mask, weight] : weights) {
        keys.push_back({mask, sum > 0.0 ? weight / sum : 0.0});
    }
    return keys;
}

}  // namespace glint::testing
