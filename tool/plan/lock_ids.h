// Assigns shader IDs to cases so that they stay the same from build to build.
#pragma once

#include "materials/material_model.h"
#include "plan/merge.h"

#include <map>
#include <span>
#include <vector>

namespace glint::compiler {

// The shader ID of each key, as a lock file keeps it. Keys with the same ID shared a case.
using LockedIds = std::map<materials::FeatureMask, int>;

// Every ID up to the highest in use has a bucket and a row in tables. This limit keeps a wrong number in a
// file from allocating gigabytes for them.
inline constexpr int kMaxLockedId = 65535;

// Returns the shader ID of each case; all of them are different. A case takes the ID that most of its keys
// have in `locked`. If two cases want the same ID, the case that comes first in this order keeps it: more
// keys that have it, more hits, lower ID, earlier case. The other case takes the next of its keys' IDs. A
// case that gets none of them gets the lowest ID that nothing in `locked` has. Requires that every key is in
// one case, as mergeKeys() ensures.
std::vector<int> assignShaderIds(std::span<const WeightedKey> keys, std::span<const CaseKeys> cases,
                                 const LockedIds& locked);

}  // namespace glint::compiler
