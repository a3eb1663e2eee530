// Which keys share a case, by policy.
#pragma once

#include "plan/cost.h"

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace glint {

enum class MergePolicy : std::uint8_t {
    None,     // every key its own case
    Family,   // keys with the same lobes
    All,      // one case
    Auto,     // by the cost model of plan/cost.h and hits, within a budget of cases
    Profile,  // by hits that were counted: frequent keys their own case, the others merged
};

// Cases that Auto and Profile make at most where nothing else is asked for. A choice: more than the families
// of most scenes, and few enough for an uber shader to compile in seconds.
inline constexpr int kDefaultMaxCases = 32;

// Auto: keys that can't pay for a case share one, the rarest first, as long as together they have no more
// than kRestShare of the hits. Such a key has less than kRareShare: what it could spare is then less than
// kCaseCost even at 5000 instructions a hit, twice those of the largest shader of one key that Glint has.
inline constexpr double kRareShare = kCaseCost / 5000.0;
inline constexpr double kRestShare = 0.05;
// Clusters that Auto starts with at most, as its time grows with their square: the rarest keys beyond are
// rest.
inline constexpr std::size_t kMaxStart = 512;

// Profile: the most frequent keys that together have this share of the hits are hot.
inline constexpr double kHotShare = 0.95;

// Why the keys of a case share it.
enum class CaseReason : std::uint8_t {
    Own,     // it has one key
    Family,  // --merge family
    All,     // --merge all
    Cost,    // merging spares more than it costs
    Budget,  // merging costs more than it spares, but there would be too many cases
    Rest,    // rare keys
    Hot,     // one key with many hits
    Cold,    // keys with few hits
    NeverHit,
};

struct CaseKeys {
    std::vector<int> keys;  // indices, ascending
    CaseReason reason = CaseReason::Own;
};

// Every key is in one case; cases in ascending order of their smallest keys. `keys`: ascending by mask.
// `maxCases`: for Auto and Profile, at least 1; the others don't look at it.
std::vector<CaseKeys> mergeKeys(std::span<const WeightedKey> keys, MergePolicy merge, int maxCases);

std::string_view toString(MergePolicy merge);
std::string_view toString(CaseReason reason);  // one word: "cold"
std::string_view explain(CaseReason reason);   // a sentence without a full stop

}  // namespace glint
