// The changes that a plan makes to a lock of shader IDs.
#pragma once

#include "plan/lock_ids.h"
#include "plan/plan.h"

#include <vector>

namespace glint::compiler {

struct MovedKey {
    materials::FeatureMask mask = 0;
    int from = 0;
    int to = 0;
    // Other cases have kept all IDs that this key's case had, so `to` is a new ID.
    bool lostId = false;
};

// The lists are in the order of masks.
struct LockUpdate {
    LockedIds ids;                              // the new content of the lock
    std::vector<materials::FeatureMask> added;  // keys that had no ID so far
    std::vector<MovedKey> moved;                // keys whose ID has changed
    std::vector<materials::FeatureMask> stale;  // keys of the lock that the plan lacks

    // Returns whether the new content differs from the old one.
    bool changes(const LockedIds& locked) const {
        return ids != locked;
    }
};

// `plan` was made with these IDs. Keys that the plan lacks stay in the lock, so that they keep their ID when
// they return, unless `prune` is set.
LockUpdate updateLock(const LockedIds& locked, const Plan& plan, bool prune);

}  // namespace glint::compiler
