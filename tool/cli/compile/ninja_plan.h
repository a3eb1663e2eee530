// glint compile --plan-only: writes what is to be compiled as files for Ninja.
#pragma once

#include "cli/compile/arguments.h"
#include "emit/compile.h"

#include <glint/result.h>

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint::cli {

struct NinjaModule {
    std::string name;                  // for people
    std::string input;                 // path of the module's text
    std::string output;                // path of the compiled module
    std::vector<std::string> parts{};  // paths of compiled modules that it reads, too
};

struct NinjaPlan {
    std::string tool;                  // path of glint
    std::string launcher;              // words of a shell before each compilation; may be empty
    std::string folder;                // of the build file and what Ninja keeps
    std::string file;                  // the build file itself
    std::vector<NinjaModule> modules;  // at least one
    std::vector<std::string> outputs;  // of the package, at least one
    std::vector<std::string> plan;     // words after the tool's that make the plan again
    std::string planDepfile;           // what the plan was made of
    std::vector<std::string> package;  // words after the tool's that make the package of the modules
    std::string packageDepfile;        // what that run lists as read
};

// Paths and words may contain any character except a line break, and paths no '|', which Ninja can't handle:
// error "ninja-name".
Result<std::string> makeNinjaFile(const NinjaPlan& plan);

// The beginning of each file from makeNinjaFile().
inline constexpr std::string_view kNinjaFirstWords = "# Made by glint compile --plan-only";

// Returns `text` as one word of a POSIX shell.
std::string shellWord(const std::string& text);

// Writes a text for each module and the build file into arguments.planOnly, but only files that changed, and
// removes the modules of an earlier plan. `dependencies` are the files that were read. Errors:
// "output-not-a-plan" if the folder has another build.ninja, "ninja-name", "depfile-name", "file-write".
Status writePlan(const CompileArguments& arguments, const compiler::PackagePlan& plan,
                 std::span<const std::string> dependencies);

}  // namespace glint::cli
