// The lock file, which keeps shader IDs from build to build.
#pragma once

#include "gltf/scene_list.h"
#include "plan/lock_text.h"
#include "plan/plan.h"
#include "settings/settings.h"

#include <glint/result.h>

#include <optional>
#include <string>
#include <vector>

namespace glint::compiler {

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
