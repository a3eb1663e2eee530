// Decides which keys share a case, by policy.
#pragma once

#include "plan/cost.h"

#include <glint/result.h>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
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

enum class MergePolicy : std::uint8_t {
    None,     // each key has its own case
    Family,   // keys with the same lobes share a case
    All,      // all keys share one case
    Auto,     // by the time that frames are expected to take, within a budget of cases
    Profile,  // by counted hits: frequent keys have their own case, the others are merged
};
inline constexpr Named<MergePolicy> kMergeNames[] = {
    {MergePolicy::None, "none", "every permutation has its own"},
    {MergePolicy::Family, "family", "those with the same lobes share one, which branches on their inputs"},
    {MergePolicy::All, "all", "one shader"},
    {MergePolicy::Auto, "auto", "decided for the strategies by a cost model, within --max-shaders"},
    {MergePolicy::Profile, "profile", "those with many counted hits have their own, the others are merged"},
};
constexpr std::span<const Named<MergePolicy>> namesOf(MergePolicy /*type*/) {
    return kMergeNames;
}

// The most cases that Auto and Profile make by default. It is a choice: more than the families of most
// scenes, and few enough for an uber shader to compile in seconds.
inline constexpr int kDefaultMaxCases = 32;

// Where cases are chosen by instructions in vain, keys that can't pay for a case share one. The rarest keys
// are taken first, as long as together they have at most kRestShare of the hits. Each of them has less than
// kRareShare: it could then save less than kCaseCost even at 5000 instructions a hit, which is twice as many
// as the largest shader of one key has.
inline constexpr double kRareShare = kCaseCost / 5000.0;
inline constexpr double kRestShare = 0.05;
// The most clusters that it starts with, as its time grows with their square. The rarest keys beyond are
// merged first.
inline constexpr std::size_t kMaxStart = 512;

// With Profile, the most frequent keys that together have this share of the hits are hot.
inline constexpr double kHotShare = 0.95;

// The reason why the keys of a case share it.
enum class CaseReason : std::uint8_t {
    Own,     // The case has one key.
    Family,  // --merge family
    All,     // --merge all
    Cost,    // Merging saves more than it costs.
    Budget,  // Merging costs more than it saves, but there would be too many cases.
    Rest,    // rare keys
    Hot,     // one key with many hits
    Cold,    // keys with few hits
    NeverHit,
};

struct CaseKeys {
    std::vector<int> keys;  // indices, ascending
    CaseReason reason = CaseReason::Own;
};

// Returns the cases in ascending order of their smallest keys; every key is in exactly one. `keys` must be
// ascending by mask. `maxCases` is at least 1; only Auto and Profile read it. Auto makes those with which an
// average hit runs fewest instructions in vain.
std::vector<CaseKeys> mergeKeys(std::span<const WeightedKey> keys, MergePolicy merge, int maxCases);

// Cases among which the expected time of a frame decides (plan/frame_time.h).
struct MergeCandidate {
    std::string name;  // for people: "family", "families in 4"
    std::vector<CaseKeys> cases;
};
// Returns cases as those of mergeKeys(), each within `maxCases`, which is at least 1: those of None, Family
// and All, families merged to 2, 4, 8… cases, and those of Auto ("least in vain"), which have the name of
// another policy if its cases are the same.
std::vector<MergeCandidate> mergeCandidates(std::span<const WeightedKey> keys, int maxCases);

// The time that a frame of all scenes is expected to take with some cases (plan/frame_time.h).
struct MergeEstimate {
    std::string name;  // of MergeCandidate
    std::size_t cases = 0;
    double inVain = 0.0;     // by plan/cost.h, in instructions of an average hit
    double firstMs = 0.0;    // first hits
    std::vector<double> ms;  // first hits and rays, by strategy
    bool chosen = false;
};

std::string_view toString(CaseReason reason);  // one word: "cold"
std::string_view explain(CaseReason reason);   // a sentence without a full stop

// Found by their arguments from other namespaces.
using glint::nameOf;

}  // namespace glint::compiler
