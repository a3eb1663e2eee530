// Assigns shader IDs to cases so that they stay the same from build to build, as a lock file keeps them.
#pragma once

#include "materials/material_model.h"
#include "plan/merge.h"

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <variant>
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

// The text of a lock file, which is made to be compared and merged line by line.
//
//     # comment
//     version 1
//     4 -
//     0 baseColorTexture texCoord0 normals
//
// Each line is a key: its shader ID and the names of its features, or "-" if it has none. Lines are sorted by
// the names, so that two branches seldom add lines in the same place. Blank lines, the order of lines and of
// names, and repeated lines mean nothing.

struct LockTextError {
    int line = 0;  // from 1
    std::string message;
    std::string hint;
    std::string unknownFeature;  // the word that names no feature, if that is the error
};

// A key to which two lines give different IDs; the lower ID counts.
struct RepeatedLockKey {
    int line = 0;  // the later of the two lines
    materials::FeatureMask mask = 0;
    int kept = 0;
    int ignored = 0;
};

struct LockText {
    LockedIds ids;
    std::vector<RepeatedLockKey> repeated;
};

std::variant<LockText, LockTextError> parseLock(
    std::string_view text, const materials::MaterialModel& model = materials::builtinMaterialModel());

// Formats a lock file. parseLock() gives the same IDs back, and the same IDs always give the same text.
std::string formatLock(const LockedIds& ids,
                       const materials::MaterialModel& model = materials::builtinMaterialModel());

// Returns a key as the file has it: "baseColorTexture texCoord0", or "-".
std::string lockKeyName(const materials::FeatureMask& mask,
                        const materials::MaterialModel& model = materials::builtinMaterialModel());

}  // namespace glint::compiler
