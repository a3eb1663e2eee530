#include "plan/cluster.h"

#include <algorithm>
#include <cassert>
#include <limits>

namespace glint {

namespace {

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

struct Group {
    Cluster cluster;
    KeySet set;
    double cost = 0.0;
    bool alive = true;
    // The later group with which merging costs least, and what that adds to the cost of all.
    std::size_t partner = kNone;
    double increase = 0.0;
};

double increaseOf(const Group& a, const Group& b) {
    return mergingCost(a.set, b.set) - a.cost - b.cost - kCaseCost;
}

void findPartner(std::vector<Group>& groups, std::size_t index) {
    Group& group = groups[index];
    group.partner = kNone;
    for (std::size_t other = index + 1; other < groups.size(); ++other) {
        if (!groups[other].alive) {
            continue;
        }
        const double increase = increaseOf(group, groups[other]);
        if (group.partner == kNone || increase < group.increase) {
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
        group.set = toSet(keys[static_cast<std::size_t>(cluster.keys.front())]);
        for (std::size_t i = 1; i < cluster.keys.size(); ++i) {
            group.set = unionOf(group.set, toSet(keys[static_cast<std::size_t>(cluster.keys[i])]));
        }
        group.cost = mergingCost(group.set);
        group.cluster = std::move(cluster);
        groups.push_back(std::move(group));
    }
    for (std::size_t i = 0; i < groups.size(); ++i) {
        findPartner(groups, i);
    }
    return groups;
}

// The group whose merge with its partner costs least; kNone where only one is left.
std::size_t cheapest(const std::vector<Group>& groups) {
    std::size_t best = kNone;
    for (std::size_t i = 0; i < groups.size(); ++i) {
        const bool merges = groups[i].alive && groups[i].partner != kNone;
        if (merges && (best == kNone || groups[i].increase < groups[best].increase)) {
            best = i;
        }
    }
    return best;
}

// Merges groups[index] with its partner, whose place dies.
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

    // Only what knew either of the two, or stands before the union, can have another partner now.
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

}  // namespace

std::vector<Cluster> agglomerate(std::vector<Cluster> start, std::span<const WeightedKey> keys,
                                 int maxClusters) {
    assert(maxClusters >= 1);
    std::vector<Group> groups = makeGroups(std::move(start), keys);
    std::size_t alive = groups.size();
    for (std::size_t best = cheapest(groups); best != kNone; best = cheapest(groups)) {
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

}  // namespace glint
