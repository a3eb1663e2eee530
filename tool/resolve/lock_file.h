// The lock file, which keeps shader IDs from build to build.
#pragma once

#include "gltf/scene_list.h"
#include "plan/lock.h"
#include "plan/plan.h"
#include "settings/settings.h"

#include <glint/result.h>

#include <optional>
#include <string>
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

// Reads the file of a request that names one. The result is empty if there is no file yet. Errors: those of
// readFile() and checkOutputFile(); "lock-format" with the line.
Result<LockText> readLock(const LockRequest& request, const materials::MaterialModel& model);

// Returns what is to be written to the file, or nothing if it stays as it is. `plan` has the IDs of `before`.
// Warns of keys whose IDs clash ("lock-conflict"). Notes report other IDs that change ("lock-moved") and keys
// that no scene has ("lock-stale"). Error "lock-outdated" with --locked if something would change.
Result<std::optional<std::string>> updateLock(const LockRequest& request, const LockText& before,
                                              const gltf::SceneList& scenes, const Plan& plan,
                                              std::vector<Diagnostic>& messages);

}  // namespace glint::compiler
