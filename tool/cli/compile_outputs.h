// All that glint compile writes, as one step: all of it is on disk before any of it takes its place.
#pragma once

#include "cli/depfile.h"
#include "cli/lock_option.h"
#include "emit/compile.h"
#include "gltf/scene_list.h"

#include <glint/result.h>

#include <filesystem>
#include <span>
#include <string>

namespace glint {

// What is empty is not written.
struct CompileOutputs {
    std::filesystem::path folder;  // of the package
    std::filesystem::path embed;   // a C++ source
    const LockArguments& lock;
    const LockChoice& lockChoice;
    const DepfileArguments& depfile;
    std::span<const std::string> dependencies;
};

// A full disk leaves everything as it was, and so does an interruption: it waits. Errors of writePackage(),
// stageEmbeddedSource() and makeDepfile(); "file-write".
Status writeOutputs(const SceneList& scenes, const CompiledPackage& package, const CompileOutputs& outputs);

}  // namespace glint
