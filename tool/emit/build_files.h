// Files for Make and Ninja: which files a run has read, and modules that are compiled one by one.
#pragma once

#include "emit/package/compiled_package.h"

#include <glint/result.h>

#include <span>
#include <string>
#include <vector>

namespace glint::compiler {

// A dependency file in Make's syntax.
struct Depfile {
    std::string file;                  // empty: none
    std::vector<std::string> targets;  // at least one, where there is a file
};

// Returns "targets: dependencies", with each dependency once. Error "depfile-name" for a name that can't be
// written in a syntax that both Make and Ninja read: with a quote or one of &*;<>?^`| or a control character,
// a colon at the end, or a backslash at the end or before a space, '#' or ':'; a target with '=' or '%';
// dependencies that all contain a '='.
Result<std::string> makeDepfile(std::span<const std::string> targets,
                                std::span<const std::string> dependencies);

// Writes the file if its content changes. Does nothing if no file is named. Has the errors of makeDepfile(),
// and "file-write".
Status writeDepfile(const Depfile& depfile, std::span<const std::string> dependencies);

// The folder of a plan.
struct PlanFolder {
    std::string path;

    std::string buildFile() const;
    std::string modules() const;         // folder of the modules, before and after
    std::string planDepfile() const;     // what the plan was made of
    std::string packageDepfile() const;  // what making the package lists as read
};

// The compilation of a package by Ninja.
struct NinjaPlan {
    std::string tool;                  // path of glint
    std::string launcher;              // words of a shell before each compilation; may be empty
    PlanFolder folder;                 // of the build file and what Ninja keeps
    std::vector<std::string> outputs;  // of the package, at least one
    std::vector<std::string> plan;     // words after the tool's that make the plan again
    std::vector<std::string> package;  // words after the tool's that make the package of the modules
};

// Writes a text for each module of `package` and the build file into the plan's folder, but only files that
// changed, and removes the modules of an earlier plan. `dependencies` are the files that were read. Paths and
// words may contain any character except a line break, and paths no '|', which Ninja can't handle. Errors:
// "output-not-a-plan" if the folder has another build.ninja, "ninja-name", "depfile-name", "file-write".
Status writePlan(const NinjaPlan& plan, const PackagePlan& package,
                 std::span<const std::string> dependencies);

}  // namespace glint::compiler
