#include "plan/cluster.h"

#include <algorithm>
#include <cassert>
#include <limits>

namespace glint::compiler {

namespace {

constexpr std::size_t kNobody = std::numeric_limits<std::size_t>::max();

struct Group {
    Cluster cluster;
    KeySet set;
    double cost = 0.0;
    bool alive = true;
    // `partner` is the later group with which merging costs least; `increase` is the cost that this merge
    // adds to the total.
    std::size_t partner = kNobody;
    double increase = 0.0;
};

double increaseOf(const Group& a, const Group& b) {
    return mergingCost(a.set, b.set) - a.cost - b.cost - kCaseCost;
}

void findPartner(std::vector<Group>& groups, std::size_t index) {
    Group& group = groups[index];
    group.partner = kNobody;
    for (std::size_t other = index + 1; other < groups.size(); ++other) {
        if (!groups[other].alive) {
            continue;
        }
        const double increase = increaseOf(group, groups[other]);
        if (group.partner == kNobody || increase < group.increase) {
            group.partner = other;
            group.increase = increase;
        }
    }
}

std::vector<Group> makeGroups(std::vector<Cluster> start, std::span<const WeightedKey> keys) {
    for (Cluster& cluster : start) {
        assert(!cluster.keys.empty());
        std::ranges::sort(cluster.keys);
    }
    std::ranges::sort(start, {}, [](const Cluster& cluster) { return cluster.keys.front(); });
    std::vector<Group> groups;
    groups.reserve(start.size());
    for (Cluster& cluster : start) {
        Group group;
        group.set = toSet(cluster.keys, keys);
        group.cost = mergingCost(group.set);
        group.cluster = std::move(cluster);
        groups.push_back(std::move(group));
    }
    for (std::size_t i = 0; i < groups.size(); ++i) {
        findPartner(groups, i);
    }
    return groups;
}

// Returns the group whose merge with its partner costs least, or kNobody if only one group is left.
std::size_t cheapest(const std::vector<Group>& groups) {
    std::size_t best = kNobody;
    for (std::size_t i = 0; i < groups.size(); ++i) {
        const bool merges = groups[i].alive && groups[i].partner != kNobody;
        if (merges && (best == kNobody || groups[i].increase < groups[best].increase)) {
            best = i;
        }
    }
    return best;
}

// Merges groups[index] with its partner, and marks the partner's entry as dead.
void mergeWithPartner(std::vector<Group>& groups, std::size_t index) {
    Group& group = groups[index];
    const std::size_t gone = group.partner;
    Group& other = groups[gone];
    group.cluster.forced = group.cluster.forced || other.cluster.forced || group.increase >= 0.0;
    std::vector<int>& list = group.cluster.keys;
    list.insert(list.end(), other.cluster.keys.begin(), other.cluster.keys.end());
    std::ranges::sort(list);
    group.set = unionOf(group.set, other.set);
    group.cost = mergingCost(group.set);
    other.alive = false;

    // The partner can only change for groups whose partner was one of the two, and for groups before the
    // union.
    for (std::size_t i = 0; i < gone; ++i) {
        Group& earlier = groups[i];
        if (!earlier.alive) {
            continue;
        }
        if (i == index || earlier.partner == index || earlier.partner == gone) {
            findPartner(groups, i);
        } else if (i < index) {
            const double increase = increaseOf(earlier, group);
            if (increase < earlier.increase || (increase == earlier.increase && index < earlier.partner)) {
                earlier.partner = index;
                earlier.increase = increase;
            }
        }
    }
}

// A move must save more than the rounding error of the sums, or keys could move back and forth forever.
constexpr double kLeastSaving = 1e-9;

// The state of moveKeys(): here clusters have no partners, and a cluster that loses its last key is not
// alive.
struct Movable {
    Cluster cluster;
    KeySet set;
    double cost = 0.0;  // with kCaseCost; 0 for none

    void update(std::span<const WeightedKey> keys) {
        const bool isEmpty = cluster.keys.empty();
        set = isEmpty ? KeySet{} : toSet(cluster.keys, keys);
        cost = isEmpty ? 0.0 : mergingCost(set) + kCaseCost;
    }
};

// Returns the index of the cluster to which moving `key` costs least, if that is less than `saving`, else
// kNobody.
std::size_t betterPlace(const std::vector<Movable>& places, std::size_t from, const KeySet& key,
                        double saving, bool mayOpen) {
    std::size_t best = kNobody;
    double least = saving - kLeastSaving;
    bool opened = false;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const bool isEmpty = places[i].cluster.keys.empty();
        if (i == from || (isEmpty && (!mayOpen || opened))) {
            continue;
        }
        opened = opened || isEmpty;
        const double increase =
            isEmpty ? kCaseCost : mergingCost(places[i].set, key) + kCaseCost - places[i].cost;
        if (increase < least) {
            best = i;
            least = increase;
        }
    }
    return best;
}

// Returns whether `key` moved.
bool moveKey(std::vector<Movable>& places, std::vector<std::size_t>& placeOf, int key,
             std::span<const WeightedKey> keys, int maxClusters) {
    const std::size_t from = placeOf[static_cast<std::size_t>(key)];
    Movable rest;
    rest.cluster = places[from].cluster;
    std::erase(rest.cluster.keys, key);
    rest.update(keys);
    const auto alive =
        std::ranges::count_if(places, [](const Movable& place) { return !place.cluster.keys.empty(); });
    const bool mayOpen = !rest.cluster.keys.empty() && alive < maxClusters;
    const std::size_t to = betterPlace(places, from, toSet(keys[static_cast<std::size_t>(key)]),
                                       places[from].cost - rest.cost, mayOpen);
    if (to == kNobody) {
        return false;
    }
    places[from] = std::move(rest);
    std::vector<int>& list = places[to].cluster.keys;
    list.insert(std::ranges::upper_bound(list, key), key);
    places[to].update(keys);
    placeOf[static_cast<std::size_t>(key)] = to;
    return true;
}

}  // namespace

std::vector<Cluster> agglomerate(std::vector<Cluster> start, std::span<const WeightedKey> keys,
                                 int maxClusters) {
    assert(maxClusters >= 1);
    std::vector<Group> groups = makeGroups(std::move(start), keys);
    std::size_t alive = groups.size();
    for (std::size_t best = cheapest(groups); best != kNobody; best = cheapest(groups)) {
        const bool isWithinBudget = alive <= static_cast<std::size_t>(maxClusters);
        if (isWithinBudget && groups[best].increase >= 0.0) {
            break;
        }
        mergeWithPartner(groups, best);
        --alive;
    }
    std::vector<Cluster> clusters;
    for (Group& group : groups) {
        if (group.alive) {
            clusters.push_back(std::move(group.cluster));
        }
    }
    return clusters;
}

std::vector<Cluster> moveKeys(std::vector<Cluster> clusters, std::span<const WeightedKey> keys,
                              int maxClusters) {
    std::vector<Movable> places(clusters.size() + 1);  // one more, empty: a key may open it
    std::vector<std::size_t> placeOf(keys.size(), kNobody);
    for (std::size_t i = 0; i < clusters.size(); ++i) {
        for (const int key : clusters[i].keys) {
            placeOf[static_cast<std::size_t>(key)] = i;
        }
        places[i].cluster = std::move(clusters[i]);
        places[i].update(keys);
    }
    bool moved = true;
    for (int round = 0; moved && round < kMaxRounds; ++round) {
        moved = false;
        for (std::size_t key = 0; key < keys.size(); ++key) {
            if (placeOf[key] != kNobody &&
                moveKey(places, placeOf, static_cast<int>(key), keys, maxClusters)) {
                moved = true;
                // One empty cluster must always be there, so that a key can open it.
                if (std::ranges::none_of(places, [](const Movable& m) { return m.cluster.keys.empty(); })) {
                    places.emplace_back();
                }
            }
        }
    }
    std::vector<Cluster> result;
    for (Movable& place : places) {
        if (!place.cluster.keys.empty()) {
            result.push_back(std::move(place.cluster));
        }
    }
    std::ranges::sort(result, {}, [](const Cluster& cluster) { return cluster.keys.front(); });
    return result;
}

double totalCost(std::span<const Cluster> clusters, std::span<const WeightedKey> keys) {
    double cost = 0.0;
    for (const Cluster& cluster : clusters) {
        cost += mergingCost(toSet(cluster.keys, keys)) + kCaseCost;
    }
    return cost;
}

}  // namespace glint::compiler
