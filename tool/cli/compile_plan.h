// glint compile --plan-only: writes what is to be compiled as files for Ninja.
#pragma once

#include "cli/compile_arguments.h"
#include "emit/compile.h"

#include <glint/result.h>

#include <span>
#include <string>

namespace glint {

// Writes a text for each module and the build file into arguments.planOnly, but only files that changed, and
// removes the modules of an earlier plan. `dependencies` are the files that were read. Errors:
// "output-not-a-plan" if the folder has another build.ninja, "ninja-name", "depfile-name", "file-write".
Status writePlan(const CompileArguments& arguments, const PackagePlan& plan,
                 std::span<const std::string> dependencies);

}  // namespace glint
