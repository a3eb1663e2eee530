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
#pragma once

#include "materials/material_model.h"
#include "plan/lock_ids.h"

#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace glint::compiler {

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
std::string lockKeyName(materials::FeatureMask mask,
                        const materials::MaterialModel& model = materials::builtinMaterialModel());

}  // namespace glint::compiler
