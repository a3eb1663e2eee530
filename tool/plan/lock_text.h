// The text of a lock file, made to be compared and merged line by line.
//
//     # comment
//     version 1
//     4 -
//     0 baseColorTexture texCoord0 normals
//
// A line a key: its shader ID and the names of its features, "-" for none, sorted by the names, so that lines
// which two branches add seldom meet. Blank lines, the order of lines and of names, and repeated lines mean
// nothing.
#pragma once

#include "plan/lock_ids.h"

#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace glint {

struct LockTextError {
    int line = 0;  // from 1
    std::string message;
    std::string hint;
    std::string unknownFeature;  // the word that is none, if that is what is wrong
};

// A key that two lines give different IDs; the lower one counts.
struct RepeatedLockKey {
    int line = 0;  // the later one
    FeatureMask mask = 0;
    int kept = 0;
    int ignored = 0;
};

struct LockText {
    LockedIds ids;
    std::vector<RepeatedLockKey> repeated;
};

std::variant<LockText, LockTextError> parseLock(std::string_view text);

// Reads back as the same IDs. The same IDs give the same text.
std::string formatLock(const LockedIds& ids);

// "baseColorTexture texCoord0", or "-": a key as in the file.
std::string lockKeyName(FeatureMask mask);

}  // namespace glint
