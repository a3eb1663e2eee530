#include "plan/cost.h"

#include "plan/cost_constants.h"

#include <algorithm>
#include <bit>
#include <cassert>

namespace glint {

namespace {

struct Code {
    double instructions = 0.0;
    double fetches = 0.0;
};

constexpr std::array<Code, 64> makeCodeByBit() {
    std::array<Code, 64> code{};
    for (const fitted::FeatureCode& row : fitted::kFeatureCode) {
        code[static_cast<std::size_t>(row.feature)] = {row.instructions, row.fetches};
    }
    return code;
}
constexpr std::array<Code, 64> kCode = makeCodeByBit();

// Returns which part of a feature's code the hits without it run in vain, if the share p of their case's hits
// have it.
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

// Returns the surplus of an average hit of a case in which the share p of the hits have the feature.
double surplusOf(std::size_t place, double p) {
    const FeatureMask feature = FeatureMask{1} << place;
    double cost = (feature & kLobeMask) != 0 ? fitted::kLobeBranch : fitted::kInputBranch;
    cost += (kCode[place].instructions + kFetchCost * kCode[place].fetches) * idleShare(p);
    if (feature == bit(Feature::Unlit)) {
        cost += fitted::kLitInstructions * idleShare(1.0 - p);
    }
    return cost;
}

template <typename ShareWith>
double surplus(double share, FeatureMask sometimes, const ShareWith& shareWith) {
    if (share <= 0.0) {
        return 0.0;
    }
    double cost = 0.0;
    forEachBit(sometimes, [&](std::size_t place) { cost += surplusOf(place, shareWith(place) / share); });
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

KeySet toSet(std::span<const int> indices, std::span<const WeightedKey> keys) {
    assert(!indices.empty());
    KeySet set;
    set.always = ~FeatureMask{0};
    for (const int index : indices) {
        const WeightedKey& key = keys[static_cast<std::size_t>(index)];
        set.share += key.share;
        set.always &= key.mask;
        set.any |= key.mask;
        forEachBit(key.mask, [&](std::size_t place) { set.shareWith[place] += key.share; });
    }
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

double branchCost(const KeySet& keys, Feature feature) {
    return surplus(keys.share, keys.any & ~keys.always & bit(feature),
                   [&](std::size_t place) { return keys.shareWith[place]; });
}

CodeEstimate estimateCode(FeatureMask always, FeatureMask sometimes) {
    CodeEstimate estimate;
    estimate.instructions = fitted::kUnlitInstructions;
    if ((always & bit(Feature::Unlit)) == 0) {
        estimate.instructions += fitted::kLitInstructions;
    }
    forEachBit(always | sometimes, [&](std::size_t place) {
        estimate.instructions += kCode[place].instructions;
        estimate.fetches += kCode[place].fetches;
    });
    estimate.lobeBranches = std::popcount(sometimes & kLobeMask);
    estimate.inputBranches = std::popcount(sometimes & ~kLobeMask);
    estimate.instructions +=
        estimate.lobeBranches * fitted::kLobeBranch + estimate.inputBranches * fitted::kInputBranch;
    return estimate;
}

}  // namespace glint
