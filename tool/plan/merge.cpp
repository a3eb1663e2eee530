#include "plan/merge.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>
#include <map>
#include <numeric>

namespace glint::compiler {

namespace {

constexpr std::string_view kLeastInVain = "least in vain";
constexpr std::size_t kNobody = std::numeric_limits<std::size_t>::max();

struct Group {
    Cluster cluster;
    KeySet set;
    int model = -1;  // modelOf(set)
    double cost = 0.0;
    bool alive = true;
    // `partner` is the later group with which merging costs least; `increase` is the cost that this merge
    // adds to the total.
    std::size_t partner = kNobody;
    double increase = 0.0;
};

// What merging keys of different base models costs, whose code has nothing in common: more than any other
// merge, so that they share a case only where there would be too many cases.
constexpr double kOtherModel = 1e9;
constexpr int kSeveralModels = -2;

// Returns the index of the model of a pack that all keys have, -1 if none has one, or kSeveralModels.
int modelOf(const KeySet& set) {
    const std::vector<materials::BaseModel>& models = set.model->models;
    const auto found = std::ranges::find_if(
        models, [&](const materials::BaseModel& model) { return set.any.has(model.firstBit - 1); });
    return found == models.end()                 ? -1
           : set.always.has(found->firstBit - 1) ? static_cast<int>(found - models.begin())
                                                 : kSeveralModels;
}

double increaseOf(const Group& a, const Group& b) {
    if (a.model != b.model || a.model == kSeveralModels) {
        return kOtherModel;
    }
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
        group.model = modelOf(group.set);
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
    group.model = modelOf(group.set);
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
    int model = -1;     // modelOf(set)
    double cost = 0.0;  // with kCaseCost; 0 for none

    void update(std::span<const WeightedKey> keys) {
        const bool isEmpty = cluster.keys.empty();
        set = isEmpty ? KeySet{} : toSet(cluster.keys, keys);
        model = modelOf(set);
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
    const int model = modelOf(key);
    for (std::size_t i = 0; i < places.size(); ++i) {
        const bool isEmpty = places[i].cluster.keys.empty();
        if (i == from || (isEmpty ? !mayOpen || opened : places[i].model != model)) {
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

namespace {

using Keys = std::span<const WeightedKey>;

materials::FeatureMask lobesOf(Keys keys) {
    return keys.empty() ? materials::FeatureMask() : keys.front().model->lobes;
}

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
                             const materials::FeatureMask& distinguishes) {
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

std::vector<CaseKeys> mergeByMask(Keys keys, const materials::FeatureMask& distinguishes, CaseReason reason) {
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
         std::array{startApart(keys, order), groupBy(keys, order, lobesOf(keys))}) {
        candidates.push_back(moveKeys(agglomerate(std::move(start), keys, maxCases), keys, maxCases));
    }
    if (keys.size() <= static_cast<std::size_t>(maxCases)) {
        candidates.push_back(groupBy(keys, order, materials::kAllFeatures));
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
        append(cases, agglomerate(groupBy(keys, cold, lobesOf(keys)), keys, static_cast<int>(left)),
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
            return mergeByMask(keys, materials::kAllFeatures, CaseReason::Own);
        case MergePolicy::Family:
            return mergeByMask(keys, lobesOf(keys), CaseReason::Family);
        case MergePolicy::All:
            return mergeByMask(keys, 0, CaseReason::All);
        case MergePolicy::Auto:
            return mergeByCost(keys, maxCases);
        case MergePolicy::Profile:
            break;
    }
    return mergeByHits(keys, maxCases);
}

std::vector<CaseKeys> inOrder(std::vector<CaseKeys> cases, bool namesSingles) {
    for (CaseKeys& shaderCase : cases) {
        std::ranges::sort(shaderCase.keys);
        if (shaderCase.keys.size() == 1 && namesSingles) {
            shaderCase.reason = CaseReason::Own;
        }
    }
    std::ranges::sort(cases, {}, [](const CaseKeys& shaderCase) { return shaderCase.keys.front(); });
    return cases;
}

}  // namespace

std::vector<CaseKeys> mergeKeys(std::span<const WeightedKey> keys, MergePolicy merge, int maxCases) {
    assert(maxCases >= 1 || (merge != MergePolicy::Auto && merge != MergePolicy::Profile));
    if (keys.empty()) {
        return {};
    }
    return inOrder(mergeBy(keys, merge, maxCases), merge != MergePolicy::Profile);
}

std::vector<MergeCandidate> mergeCandidates(std::span<const WeightedKey> keys, int maxCases) {
    assert(maxCases >= 1);
    const auto most = static_cast<std::size_t>(maxCases);
    std::vector<MergeCandidate> candidates{
        {std::string(kLeastInVain), mergeKeys(keys, MergePolicy::Auto, maxCases)}};
    for (const MergePolicy merge : {MergePolicy::None, MergePolicy::Family, MergePolicy::All}) {
        std::vector<CaseKeys> cases = mergeKeys(keys, merge, maxCases);
        const auto same = std::ranges::find_if(candidates, [&](const MergeCandidate& other) {
            return std::ranges::equal(other.cases, cases, {}, &CaseKeys::keys, &CaseKeys::keys);
        });
        if (same != candidates.end()) {
            same->name = same->name == kLeastInVain ? std::string(nameOf(merge)) : same->name;
        } else if (cases.size() <= most) {
            candidates.push_back({std::string(nameOf(merge)), std::move(cases)});
        }
    }
    const std::vector<Cluster> families = groupBy(keys, byShare(keys), lobesOf(keys));
    for (std::size_t count = 2; count < families.size() && count <= most; count *= 2) {
        std::vector<CaseKeys> cases;
        append(cases, agglomerate(families, keys, static_cast<int>(count)), CaseReason::Cost);
        candidates.push_back({fmt::format("families in {}", cases.size()), inOrder(std::move(cases), true)});
    }
    return candidates;
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
