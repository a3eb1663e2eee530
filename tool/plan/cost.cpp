#include "plan/cost.h"

#include "plan/cost_constants.h"

#include <algorithm>
#include <cassert>

namespace glint::compiler {

namespace {

// Returns the part of a feature's code that hits without it run in vain, if the share p of their case's hits
// have it.
double idleShare(double p) {
    double noLane = 1.0 - std::clamp(p, 0.0, 1.0);
    for (int lanes = 1; lanes < kSubgroupSize; lanes *= 2) {
        noLane *= noLane;
    }
    return std::max(0.0, 1.0 - noLane - p);
}

// Calls use(feature) for each feature of `mask`, the lowest bit first. Bits that the model does not have are
// skipped.
template <typename Use>
void forEachFeature(const materials::MaterialModel& model, const materials::FeatureMask& mask,
                    const Use& use) {
    // Those of models come last, and follow each other as their bits do.
    const int ofModels = model.models.empty() ? 0
                                              : model.models.back().firstBit + model.models.back().bits -
                                                    materials::kFirstOfModels;
    const std::size_t shared = model.features.size() - static_cast<std::size_t>(ofModels);
    for (std::size_t i = 0; i < shared; ++i) {
        if (mask.has(model.features[i].bit)) {
            use(model.features[i]);
        }
    }
    mask.forEach([&](int bit) {
        const int place = bit - materials::kFirstOfModels;
        if (place >= 0 && place < ofModels) {
            use(model.features[shared + static_cast<std::size_t>(place)]);
        }
    });
}

// Returns the surplus of an average hit of a case in which the share p of the hits have the feature.
double surplusOf(const materials::Feature& feature, bool isUnlit, double p) {
    double cost = feature.isLobe ? fitted::kLobeBranch : fitted::kInputBranch;
    cost += (feature.cost.instructions + kFetchCost * feature.cost.fetches) * idleShare(p);
    if (isUnlit) {
        cost += fitted::kLitInstructions * idleShare(1.0 - p);
    }
    return cost;
}

template <typename ShareWith>
double surplus(const materials::MaterialModel& model, double share, const materials::FeatureMask& sometimes,
               const ShareWith& shareWith) {
    if (share <= 0.0) {
        return 0.0;
    }
    double cost = 0.0;
    forEachFeature(model, sometimes, [&](const materials::Feature& feature) {
        const double with = shareWith(feature.bit);
        cost += surplusOf(feature, model.unlit.has(feature.bit), with / share);
    });
    return share * cost;
}

// Returns the instructions that the hits of keys run if each key has a shader of its own, times their share.
template <typename ShareWith>
double ownCode(const materials::MaterialModel& model, double share, const materials::FeatureMask& any,
               const ShareWith& shareWith) {
    double code = share * (fitted::kUnlitInstructions + fitted::kLitInstructions);
    forEachFeature(model, any, [&](const materials::Feature& feature) {
        const bool isUnlit = model.unlit.has(feature.bit);
        code += shareWith(feature.bit) * (feature.cost.instructions + kFetchCost * feature.cost.fetches -
                                          (isUnlit ? fitted::kLitInstructions : 0.0));
    });
    return code;
}

template <typename ShareWith>
double mergingCost(const KeySet& like, double share, const materials::FeatureMask& always,
                   const materials::FeatureMask& any, const ShareWith& shareWith) {
    const materials::FeatureMask sometimes = any & ~always;
    const double inVain = surplus(*like.model, share, sometimes, shareWith);
    if (like.branchFactor <= 1.0 || sometimes == 0) {
        return inVain;
    }
    return like.branchFactor * inVain +
           (like.branchFactor - 1.0) * ownCode(*like.model, share, any, shareWith);
}

}  // namespace

double FeatureShares::operator[](int bit) const {
    const auto found = std::ranges::lower_bound(shares_, bit, {}, &std::pair<int, double>::first);
    return found != shares_.end() && found->first == bit ? found->second : 0.0;
}

void FeatureShares::add(int bit, double share) {
    const auto found = std::ranges::lower_bound(shares_, bit, {}, &std::pair<int, double>::first);
    if (found != shares_.end() && found->first == bit) {
        found->second += share;
    } else {
        shares_.insert(found, {bit, share});
    }
}

void FeatureShares::add(const FeatureShares& other) {
    for (const auto& [bit, share] : other.shares_) {
        add(bit, share);
    }
}

void FeatureShares::remove(int bit) {
    std::erase_if(shares_, [bit](const std::pair<int, double>& row) { return row.first == bit; });
}

KeySet toSet(const WeightedKey& key) {
    KeySet set;
    set.share = key.share;
    set.always = key.mask;
    set.any = key.mask;
    set.model = key.model;
    set.branchFactor = key.branchFactor;
    key.mask.forEach([&](int bit) { set.shareWith.add(bit, key.share); });
    return set;
}

KeySet toSet(std::span<const int> indices, std::span<const WeightedKey> keys) {
    assert(!indices.empty());
    KeySet set;
    set.always = materials::kAllFeatures;
    set.model = keys[static_cast<std::size_t>(indices.front())].model;
    set.branchFactor = keys[static_cast<std::size_t>(indices.front())].branchFactor;
    for (const int index : indices) {
        const WeightedKey& key = keys[static_cast<std::size_t>(index)];
        set.share += key.share;
        set.always &= key.mask;
        set.any |= key.mask;
        key.mask.forEach([&](int bit) { set.shareWith.add(bit, key.share); });
    }
    return set;
}

KeySet unionOf(const KeySet& a, const KeySet& b) {
    KeySet set;
    set.share = a.share + b.share;
    set.always = a.always & b.always;
    set.any = a.any | b.any;
    set.model = a.model;
    set.branchFactor = a.branchFactor;
    set.shareWith = a.shareWith;
    set.shareWith.add(b.shareWith);
    return set;
}

double mergingCost(const KeySet& keys) {
    return mergingCost(keys, keys.share, keys.always, keys.any, [&](int bit) { return keys.shareWith[bit]; });
}

double mergingCost(const KeySet& a, const KeySet& b) {
    return mergingCost(a, a.share + b.share, a.always & b.always, a.any | b.any,
                       [&](int bit) { return a.shareWith[bit] + b.shareWith[bit]; });
}

double branchCost(const KeySet& keys, const materials::Feature& feature) {
    return surplus(*keys.model, keys.share, keys.any & ~keys.always & feature.mask(),
                   [&](int bit) { return keys.shareWith[bit]; });
}

CodeEstimate estimateCode(const materials::FeatureMask& always, const materials::FeatureMask& sometimes,
                          const materials::MaterialModel& model) {
    CodeEstimate estimate;
    estimate.instructions = fitted::kUnlitInstructions;
    if ((always & model.unlit) == 0) {
        estimate.instructions += fitted::kLitInstructions;
    }
    forEachFeature(model, always | sometimes, [&](const materials::Feature& feature) {
        estimate.instructions += feature.cost.instructions;
        estimate.fetches += feature.cost.fetches;
    });
    estimate.lobeBranches = (sometimes & model.lobes).count();
    estimate.inputBranches = (sometimes & ~model.lobes).count();
    estimate.instructions +=
        estimate.lobeBranches * fitted::kLobeBranch + estimate.inputBranches * fitted::kInputBranch;
    return estimate;
}

CaseCode codeOf(const KeySet& keys) {
    const materials::FeatureMask sometimes = keys.any & ~keys.always;
    const double factor = sometimes != 0 ? keys.branchFactor : 1.0;
    const auto shareOf = [&](const materials::Feature& feature) {
        return keys.share > 0.0 ? keys.shareWith[feature.bit] / keys.share : 1.0;
    };
    CaseCode code{estimateCode(keys.always, sometimes, *keys.model), {}};
    forEachFeature(*keys.model, sometimes, [&](const materials::Feature& feature) {
        code.always.instructions -= feature.cost.instructions;
        code.always.fetches -= feature.cost.fetches;
        code.parts.push_back({shareOf(feature), factor * feature.cost.instructions, feature.cost.fetches});
        if (keys.model->unlit.has(feature.bit)) {
            code.always.instructions -= fitted::kLitInstructions;
            const double lit = keys.share > 0.0 ? 1.0 - shareOf(feature) : 1.0;
            code.parts.push_back({lit, factor * fitted::kLitInstructions, 0.0});
        }
    });
    code.always.instructions *= factor;
    return code;
}

}  // namespace glint::compiler
