#include "plan/merge.h"

#include "plan/cluster.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <map>
#include <numeric>

namespace glint::compiler {

namespace {

using Keys = std::span<const WeightedKey>;

// Returns the indices of the keys, those with most hits first. Equal keys are ordered by mask, ascending.
std::vector<int> byShare(Keys keys) {
    std::vector<int> order(keys.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::stable_sort(order, std::ranges::greater(),
                             [&](int key) { return keys[static_cast<std::size_t>(key)].share; });
    return order;
}

// Groups the keys whose masks agree in the bits of `distinguishes`.
std::vector<Cluster> groupBy(Keys keys, const std::vector<int>& indices,
                             materials::FeatureMask distinguishes) {
    std::map<materials::FeatureMask, Cluster> groups;
    for (const int key : indices) {
        groups[keys[static_cast<std::size_t>(key)].mask & distinguishes].keys.push_back(key);
    }
    std::vector<Cluster> clusters;
    clusters.reserve(groups.size());
    for (auto& [mask, cluster] : groups) {
        clusters.push_back(std::move(cluster));
    }
    return clusters;
}

void append(std::vector<CaseKeys>& cases, std::vector<Cluster> clusters, CaseReason reason) {
    for (Cluster& cluster : clusters) {
        cases.push_back({std::move(cluster.keys), reason});
    }
}

std::vector<CaseKeys> mergeByMask(Keys keys, materials::FeatureMask distinguishes, CaseReason reason) {
    std::vector<CaseKeys> cases;
    append(cases, groupBy(keys, byShare(keys), distinguishes), reason);
    return cases;
}

// Takes the rare keys off the end of `order` and returns them.
std::vector<int> takeRest(Keys keys, std::vector<int>& order) {
    std::vector<int> rest;
    double share = 0.0;
    while (!order.empty()) {
        const double next = keys[static_cast<std::size_t>(order.back())].share;
        const bool isRare = next < kRareShare && share + next <= kRestShare;
        if (!isRare && order.size() + (rest.empty() ? 0 : 1) <= kMaxStart) {
            break;
        }
        share += next;
        rest.push_back(order.back());
        order.pop_back();
    }
    return rest;
}

// Returns one cluster for each key, but a single cluster for all rare keys.
std::vector<Cluster> startApart(Keys keys, std::vector<int> order) {
    std::vector<int> rest = takeRest(keys, order);
    std::vector<Cluster> start;
    start.reserve(order.size() + 1);
    for (const int key : order) {
        start.push_back({{key}});
    }
    if (!rest.empty()) {
        start.push_back({std::move(rest)});
    }
    return start;
}

// Returns the cheapest of these: greedy merging that starts from single keys, greedy merging that starts from
// families, and the results of the other policies if the budget allows them. So no other policy is better. If
// several cost the same, the first is taken.
std::vector<Cluster> cheapestClusters(Keys keys, int maxCases) {
    const std::vector<int> order = byShare(keys);
    std::vector<std::vector<Cluster>> candidates;
    for (std::vector<Cluster>& start :
         std::array{startApart(keys, order), groupBy(keys, order, materials::kLobeMask)}) {
        candidates.push_back(moveKeys(agglomerate(std::move(start), keys, maxCases), keys, maxCases));
    }
    if (keys.size() <= static_cast<std::size_t>(maxCases)) {
        candidates.push_back(groupBy(keys, order, ~materials::FeatureMask{0}));
    }
    candidates.push_back(groupBy(keys, order, 0));
    const auto cost = [&](const std::vector<Cluster>& clusters) { return totalCost(clusters, keys); };
    return std::move(*std::ranges::min_element(candidates, {}, cost));
}

std::vector<CaseKeys> mergeByCost(Keys keys, int maxCases) {
    std::vector<CaseKeys> cases;
    for (Cluster& cluster : cheapestClusters(keys, maxCases)) {
        const auto isRare = [&](int key) { return keys[static_cast<std::size_t>(key)].share < kRareShare; };
        const double apart = kCaseCost * static_cast<double>(cluster.keys.size() - 1);
        const bool pays = mergingCost(toSet(cluster.keys, keys)) <= apart;
        const bool isRest = std::ranges::all_of(cluster.keys, isRare);
        const CaseReason reason = isRest                    ? CaseReason::Rest
                                  : cluster.forced || !pays ? CaseReason::Budget
                                                            : CaseReason::Cost;
        cases.push_back({std::move(cluster.keys), reason});
    }
    return cases;
}

// Returns how many of the most frequent keys together have kHotShare of the hits.
std::size_t countHot(Keys keys, const std::vector<int>& order) {
    double covered = 0.0;
    std::size_t hot = 0;
    while (hot < order.size() && covered < kHotShare &&
           keys[static_cast<std::size_t>(order[hot])].share > 0.0) {
        covered += keys[static_cast<std::size_t>(order[hot])].share;
        ++hot;
    }
    return hot;
}

std::vector<CaseKeys> mergeByHits(Keys keys, int maxCases) {
    const auto budget = static_cast<std::size_t>(maxCases);
    const std::vector<int> order = byShare(keys);
    std::size_t hot = countHot(keys, order);
    // If not all hot keys can have a case of their own, a quarter of the cases is left for those that can't.
    const std::size_t others = hot < order.size() ? 1 : 0;
    if (hot + others > budget) {
        hot = budget - std::max<std::size_t>(1, budget / 4);
    }
    const auto firstUnhit = std::ranges::find_if(
        order, [&](int key) { return keys[static_cast<std::size_t>(key)].share <= 0.0; });
    const auto firstCold = order.begin() + static_cast<std::ptrdiff_t>(hot);
    std::vector<int> cold(firstCold, firstUnhit);
    std::vector<int> unhit(firstUnhit, order.end());

    std::vector<CaseKeys> cases;
    for (auto key = order.begin(); key != firstCold; ++key) {
        cases.push_back({{*key}, CaseReason::Hot});
    }
    if (!unhit.empty() && !cold.empty() && budget - hot < 2) {
        cold.insert(cold.end(), unhit.begin(), unhit.end());
        unhit.clear();
    }
    if (!cold.empty()) {
        const std::size_t left = budget - hot - (unhit.empty() ? 0 : 1);
        append(cases, agglomerate(groupBy(keys, cold, materials::kLobeMask), keys, static_cast<int>(left)),
               CaseReason::Cold);
    }
    if (!unhit.empty()) {
        cases.push_back({std::move(unhit), CaseReason::NeverHit});
    }
    return cases;
}

std::vector<CaseKeys> mergeBy(Keys keys, MergePolicy merge, int maxCases) {
    switch (merge) {
        case MergePolicy::None:
            return mergeByMask(keys, ~materials::FeatureMask{0}, CaseReason::Own);
        case MergePolicy::Family:
            return mergeByMask(keys, materials::kLobeMask, CaseReason::Family);
        case MergePolicy::All:
            return mergeByMask(keys, 0, CaseReason::All);
        case MergePolicy::Auto:
            return mergeByCost(keys, maxCases);
        case MergePolicy::Profile:
            break;
    }
    return mergeByHits(keys, maxCases);
}

}  // namespace

std::vector<CaseKeys> mergeKeys(std::span<const WeightedKey> keys, MergePolicy merge, int maxCases) {
    assert(maxCases >= 1 || (merge != MergePolicy::Auto && merge != MergePolicy::Profile));
    if (keys.empty()) {
        return {};
    }
    std::vector<CaseKeys> cases = mergeBy(keys, merge, maxCases);
    for (CaseKeys& shaderCase : cases) {
        std::ranges::sort(shaderCase.keys);
        if (shaderCase.keys.size() == 1 && merge != MergePolicy::Profile) {
            shaderCase.reason = CaseReason::Own;
        }
    }
    std::ranges::sort(cases, {}, [](const CaseKeys& shaderCase) { return shaderCase.keys.front(); });
    return cases;
}

std::string_view toString(CaseReason reason) {
    constexpr std::string_view kNames[] = {"own",  "family", "all",  "cost",     "budget",
                                           "rest", "hot",    "cold", "never-hit"};
    return kNames[static_cast<std::size_t>(reason)];
}

std::string_view explain(CaseReason reason) {
    constexpr std::string_view kSentences[] = {
        "it has one key",
        "its keys have the same lobes",
        "every key shares one case",
        "branches on what its keys differ in cost less than more cases",
        "more cases than --max-shaders allows would be better",
        "its keys are too rare to pay for cases of their own",
        "many hits of the profile have its key",
        "few hits of the profile have its keys",
        "no hit of the profile has its keys"};
    return kSentences[static_cast<std::size_t>(reason)];
}

}  // namespace glint::compiler
