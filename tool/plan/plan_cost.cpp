#include "plan/plan_cost.h"

#include "plan/merge.h"

#include <algorithm>

namespace glint::compiler {

namespace {

using Keys = std::span<const WeightedKey>;

std::vector<BranchCost> branchesOf(const KeySet& set) {
    std::vector<BranchCost> branches;
    for (const int index : set.model->indicesOf(set.any)) {
        const materials::Feature& feature = set.model->features[static_cast<std::size_t>(index)];
        if (!set.always.has(feature.bit)) {
            const double with = set.shareWith[feature.bit];
            branches.push_back(
                {&feature, set.share > 0.0 ? with / set.share : 0.0, branchCost(set, feature)});
        }
    }
    std::ranges::stable_sort(branches, std::ranges::greater(), &BranchCost::cost);
    return branches;
}

std::vector<KeyCost> keysOf(const Case& shaderCase, Keys keys, double inVain) {
    std::vector<KeyCost> costs;
    for (const int key : shaderCase.keys) {
        const WeightedKey& weighted = keys[static_cast<std::size_t>(key)];
        KeyCost cost{key, estimateCode(weighted.mask, 0, *weighted.model)};
        std::vector<int> others = shaderCase.keys;
        std::erase(others, key);
        if (!others.empty()) {
            cost.leavingAdds = mergingCost(toSet(others, keys)) + kCaseCost - inVain;
        }
        costs.push_back(cost);
    }
    return costs;
}

// If nothing hits the case, every key counts the same.
double averageOf(const std::vector<KeyCost>& costs, Keys keys, double share) {
    double sum = 0.0;
    for (const KeyCost& cost : costs) {
        const double part = share > 0.0 ? keys[static_cast<std::size_t>(cost.key)].share / share
                                        : 1.0 / static_cast<double>(costs.size());
        sum += part * cost.own.instructions;
    }
    return sum;
}

void findNearest(const std::vector<KeySet>& sets, std::vector<CaseCost>& cases) {
    for (std::size_t a = 0; a < cases.size(); ++a) {
        for (std::size_t b = 0; b < cases.size(); ++b) {
            if (a == b) {
                continue;
            }
            const double adds = mergingCost(sets[a], sets[b]) - cases[a].inVain - cases[b].inVain;
            if (!cases[a].nearest || adds < cases[a].nearest->adds) {
                cases[a].nearest = NearestCase{cases[b].shaderId, adds};
            }
        }
    }
}

}  // namespace

PlanCost costPlan(const Plan& plan, const PlanOptions& options) {
    const std::vector<WeightedKey> keys = weightedKeys(plan, options);
    PlanCost cost;
    std::vector<KeySet> sets;
    for (const Case& shaderCase : plan.cases) {
        if (shaderCase.isRetired()) {
            continue;
        }
        const KeySet& set = sets.emplace_back(toSet(shaderCase.keys, keys));
        CaseCost& entry = cost.cases.emplace_back();
        entry.shaderId = shaderCase.shaderId;
        entry.code = estimateCode(shaderCase.always, shaderCase.sometimes, *plan.model);
        entry.inVain = mergingCost(set);
        entry.saved = kCaseCost * static_cast<double>(shaderCase.keys.size() - 1);
        entry.branches = branchesOf(set);
        entry.keys = keysOf(shaderCase, keys, entry.inVain);
        entry.ownInstructions = averageOf(entry.keys, keys, set.share);
        cost.inVain += entry.inVain;
    }
    findNearest(sets, cost.cases);
    return cost;
}

double totalCost(double inVain, std::size_t cases) {
    return inVain + kCaseCost * static_cast<double>(cases);
}

}  // namespace glint::compiler
