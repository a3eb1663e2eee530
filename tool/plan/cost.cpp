#include "plan/cost.h"

#include <algorithm>
#include <bit>

namespace glint {

namespace {

std::array<double, 64> instructionsByBit() {
    std::array<double, 64> instructions{};
    for (const FeatureInfo& info : featureTable()) {
        instructions[static_cast<std::size_t>(info.feature)] = info.instructions;
    }
    return instructions;
}

// What hits that lack a feature run of it, if the share p of their case's hits have it.
double idleShare(double p) {
    double noLane = 1.0 - std::clamp(p, 0.0, 1.0);
    for (int lanes = 1; lanes < kSubgroupSize; lanes *= 2) {
        noLane *= noLane;
    }
    return std::max(0.0, 1.0 - noLane - p);
}

// Calls use(bit) for each bit of `mask`, the lowest first.
template <typename Use>
void forEachBit(FeatureMask mask, const Use& use) {
    for (; mask != 0; mask &= mask - 1) {
        use(static_cast<std::size_t>(std::countr_zero(mask)));
    }
}

template <typename ShareWith>
double surplus(double share, FeatureMask sometimes, const ShareWith& shareWith) {
    static const std::array<double, 64> kInstructions = instructionsByBit();
    if (share <= 0.0) {
        return 0.0;
    }
    double cost = 0.0;
    forEachBit(sometimes, [&](std::size_t place) {
        const FeatureMask feature = FeatureMask{1} << place;
        const double p = shareWith(place) / share;
        cost += (feature & kLobeMask) != 0 ? kLobeBranch : kInputBranch;
        cost += kInstructions[place] * idleShare(p);
        if (feature == bit(Feature::Unlit)) {
            cost += kLitInstructions * idleShare(1.0 - p);
        }
    });
    return share * cost;
}

}  // namespace

KeySet toSet(const WeightedKey& key) {
    KeySet set;
    set.share = key.share;
    set.always = key.mask;
    set.any = key.mask;
    forEachBit(key.mask, [&](std::size_t place) { set.shareWith[place] = key.share; });
    return set;
}

KeySet unionOf(const KeySet& a, const KeySet& b) {
    KeySet set;
    set.share = a.share + b.share;
    set.always = a.always & b.always;
    set.any = a.any | b.any;
    for (std::size_t place = 0; place < set.shareWith.size(); ++place) {
        set.shareWith[place] = a.shareWith[place] + b.shareWith[place];
    }
    return set;
}

double mergingCost(const KeySet& keys) {
    return surplus(keys.share, keys.any & ~keys.always,
                   [&](std::size_t place) { return keys.shareWith[place]; });
}

double mergingCost(const KeySet& a, const KeySet& b) {
    return surplus(a.share + b.share, (a.any | b.any) & ~(a.always & b.always),
                   [&](std::size_t place) { return a.shareWith[place] + b.shareWith[place]; });
}

}  // namespace glint
