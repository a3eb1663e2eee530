// Clustering of keys by the cost model: agglomeration, then moves of single keys.
#pragma once

#include "plan/cost.h"

#include <span>
#include <vector>

namespace glint {

struct Cluster {
    std::vector<int> keys;  // indices, ascending
    bool forced = false;    // a merge that did not pay, made to keep within the budget
};

// Merges the pair of clusters whose merging costs least, again and again, while there are more than
// `maxClusters` or merging spares more than it costs. Of pairs that cost the same, the one whose first and
// then second smallest key comes first, so that the result depends on `keys` alone. `start`: disjoint, none
// empty. O(n^2) steps for n clusters where few share a best partner, O(n^3) at worst. Returns clusters in
// ascending order of their smallest keys. maxClusters >= 1.
std::vector<Cluster> agglomerate(std::vector<Cluster> start, std::span<const WeightedKey> keys,
                                 int maxClusters);

// Moves single keys to other clusters or to clusters of their own, in the order of the keys, as long as that
// lowers the cost of all, within `maxClusters`; kMaxRounds times at most. O(n * clusters) a round. Returns
// clusters as agglomerate() does.
inline constexpr int kMaxRounds = 8;
std::vector<Cluster> moveKeys(std::vector<Cluster> clusters, std::span<const WeightedKey> keys,
                              int maxClusters);

// What a plan costs: the surplus of its cases, and kCaseCost for each.
double totalCost(std::span<const Cluster> clusters, std::span<const WeightedKey> keys);

}  // namespace glint
