// Writes all results of glint compile as one step: all files are complete on disk before any of them is moved
// into place.
#pragma once

#include "cli/compile/depfile.h"
#include "emit/compile.h"
#include "resolve/build.h"

#include <glint/result.h>

#include <filesystem>
#include <span>
#include <string>

namespace glint::cli {

// Members that are empty are not written. The build says whether the lock file is.
struct CompileOutputs {
    std::filesystem::path folder;  // of the package
    std::filesystem::path embed;   // a C++ source
    const DepfileArguments& depfile;
    std::span<const std::string> dependencies;
};

// A full disk leaves everything as it was. Interruptions wait until this is done. Has the errors of
// writePackage(), stageEmbeddedSource() and makeDepfile(), and "file-write".
Status writeOutputs(const compiler::Build& build, const compiler::CompiledPackage& package,
                    const CompileOutputs& outputs);

}  // namespace glint::cli
