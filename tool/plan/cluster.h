// Clustering of keys by the cost model: agglomeration, then moves of single keys.
#pragma once

#include "plan/cost.h"

#include <span>
#include <vector>

namespace glint::compiler {

struct Cluster {
    std::vector<int> keys;  // indices, ascending
    bool forced = false;    // The merge did not pay; it was made to keep within the budget.
};

// Merges the pair of clusters whose merging costs least, and repeats that while there are more than
// `maxClusters` clusters or merging saves more than it costs. If several pairs cost the same, the pair with
// the smallest first key is merged, then the one with the smallest second key, so that the result depends on
// `keys` alone. The clusters of `start` must be disjoint and not empty; maxClusters >= 1. It takes O(n^2)
// steps for n clusters if few of them share a best partner, O(n^3) at worst. Returns clusters in ascending
// order of their smallest keys.
std::vector<Cluster> agglomerate(std::vector<Cluster> start, std::span<const WeightedKey> keys,
                                 int maxClusters);

// Moves single keys to other clusters or to clusters of their own, in the order of the keys, as long as that
// lowers the total cost and keeps within `maxClusters`. It makes at most kMaxRounds rounds of O(n * clusters)
// steps. Returns clusters in the same order as agglomerate().
inline constexpr int kMaxRounds = 8;
std::vector<Cluster> moveKeys(std::vector<Cluster> clusters, std::span<const WeightedKey> keys,
                              int maxClusters);

// Returns the cost of a plan: the surplus of its cases, plus kCaseCost for each case.
double totalCost(std::span<const Cluster> clusters, std::span<const WeightedKey> keys);

}  // namespace glint::compiler
