// What a plan changes in a lock of shader IDs.
#pragma once

#include "plan/lock_ids.h"
#include "plan/plan.h"

#include <vector>

namespace glint {

struct MovedKey {
    FeatureMask mask = 0;
    int from = 0;
    int to = 0;
    // Other cases have kept all IDs that the keys of its case had; `to` is a new one.
    bool lostId = false;
};

// Lists in order of masks.
struct LockUpdate {
    LockedIds ids;                   // what the lock is to hold
    std::vector<FeatureMask> added;  // keys without an ID so far
    std::vector<MovedKey> moved;     // keys whose ID is another now
    std::vector<FeatureMask> stale;  // keys of the lock that the plan lacks

    // Whether what is to be kept differs from what was.
    bool changes(const LockedIds& locked) const {
        return ids != locked;
    }
};

// `plan`: made with these IDs. Keys that the plan lacks stay, so that they come back with their ID, unless
// `prune`.
LockUpdate updateLock(const LockedIds& locked, const Plan& plan, bool prune);

}  // namespace glint
