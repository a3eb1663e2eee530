// Shader IDs that stay the same from build to build: which case gets which.
#pragma once

#include "plan/features.h"
#include "plan/merge.h"

#include <map>
#include <span>
#include <vector>

namespace glint {

// The shader ID that each key had, as a lock file keeps it. Keys that have one ID shared a case.
using LockedIds = std::map<FeatureMask, int>;

// Every ID up to the highest in use has a bucket and a row in tables: a wrong number in a file must not ask
// for gigabytes of them.
inline constexpr int kMaxLockedId = 65535;

// The shader ID of each case, all of them different. A case takes, among the IDs that its keys have in
// `locked`, the one that most of its keys have. Where two cases want one ID, the first in this order keeps
// it: more keys that have it, more hits, lower ID, earlier case; the other takes what else its keys have. A
// case that comes away empty gets the lowest ID that nothing in `locked` has. Requires every key in one case,
// as mergeKeys() gives them.
std::vector<int> assignShaderIds(std::span<const WeightedKey> keys, std::span<const CaseKeys> cases,
                                 const LockedIds& locked);

}  // namespace glint
