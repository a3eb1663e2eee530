// --lock FILE: keeps shader IDs in a file, so that they stay the same from build to build.
#pragma once

#include "gltf/scene_list.h"
#include "plan/plan.h"

#include <glint/result.h>

#include <CLI/CLI.hpp>

#include <optional>
#include <string>
#include <vector>

namespace glint::cli {

struct LockArguments {
    std::string file;        // empty: none
    bool frozen = false;     // --locked: error rather than change the file
    bool prune = false;      // --lock-prune: keys that no scene has go
    bool isWritten = false;  // by the command; else the file must be there
};

// Adds --lock FILE; for commands that write the file also --locked and --lock-prune.
void addLockOptions(CLI::App& command, LockArguments& arguments, bool isWritten);

struct LockChoice {
    std::optional<std::string> text;  // what is to be written; nothing where the file stays as it is
    std::optional<compiler::Plan>
        plan;  // of the scenes, with the IDs of the file; nothing where no file is named
    std::vector<Diagnostic> warnings;
    std::vector<Diagnostic> notes;
};

// Reads the file and stores its IDs in `options`; does nothing if no file is named. Warns of keys whose IDs
// clash ("lock-conflict"). Notes report other IDs that change ("lock-moved") and keys that no scene has
// ("lock-stale"). Errors: those of readFile() and checkOutputFile(); "lock-format" with the line;
// "lock-outdated" with --locked if something would change.
Result<LockChoice> applyLock(const LockArguments& arguments, const gltf::SceneList& scenes,
                             compiler::PlanOptions& options);

}  // namespace glint::cli
