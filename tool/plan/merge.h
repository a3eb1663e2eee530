// Decides which keys share a case, by policy.
#pragma once

#include "plan/cost.h"

#include <glint/result.h>

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace glint::compiler {

enum class MergePolicy : std::uint8_t {
    None,     // each key has its own case
    Family,   // keys with the same lobes share a case
    All,      // all keys share one case
    Auto,     // by hits and the cost model of plan/cost.h, within a budget of cases
    Profile,  // by counted hits: frequent keys have their own case, the others are merged
};
inline constexpr Named<MergePolicy> kMergeNames[] = {
    {MergePolicy::None, "none", "every permutation has its own"},
    {MergePolicy::Family, "family", "those with the same lobes share one, which branches on their inputs"},
    {MergePolicy::All, "all", "one shader"},
    {MergePolicy::Auto, "auto", "decided by a cost model, within --max-shaders"},
    {MergePolicy::Profile, "profile", "those with many counted hits have their own, the others are merged"},
};
constexpr std::span<const Named<MergePolicy>> namesOf(MergePolicy /*type*/) {
    return kMergeNames;
}

// The most cases that Auto and Profile make by default. It is a choice: more than the families of most
// scenes, and few enough for an uber shader to compile in seconds.
inline constexpr int kDefaultMaxCases = 32;

// With Auto, keys that can't pay for a case share one. The rarest keys are taken first, as long as together
// they have at most kRestShare of the hits. Each of them has less than kRareShare: it could then save less
// than kCaseCost even at 5000 instructions a hit, which is twice as many as the largest shader of one key
// has.
inline constexpr double kRareShare = kCaseCost / 5000.0;
inline constexpr double kRestShare = 0.05;
// The most clusters that Auto starts with, as its time grows with their square. The rarest keys beyond are
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
// ascending by mask. `maxCases` is at least 1; only Auto and Profile read it.
std::vector<CaseKeys> mergeKeys(std::span<const WeightedKey> keys, MergePolicy merge, int maxCases);

std::string_view toString(CaseReason reason);  // one word: "cold"
std::string_view explain(CaseReason reason);   // a sentence without a full stop

// Found by their arguments from other namespaces.
using glint::nameOf;

}  // namespace glint::compiler
