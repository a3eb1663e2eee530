// Dependency files in Make's syntax, for Make and Ninja.
#pragma once

#include <glint/result.h>

#include <CLI/CLI.hpp>

#include <span>
#include <string>
#include <vector>

namespace glint::cli {

struct DepfileArguments {
    std::string file;                  // empty: none
    std::vector<std::string> targets;  // at least one, where there is a file
};
void addDepfileOptions(CLI::App& command, DepfileArguments& arguments);

// Returns "targets: dependencies", with each dependency once. Error "depfile-name" for a name that can't be
// written in a syntax that both Make and Ninja read: with a quote or one of &*;<>?^`| or a control character,
// a colon at the end, or a backslash at the end or before a space, '#' or ':'; a target with '=' or '%';
// dependencies that all contain a '='.
Result<std::string> makeDepfile(std::span<const std::string> targets,
                                std::span<const std::string> dependencies);

// Writes the file if its content changes. Does nothing if no file is named. Has the errors of makeDepfile(),
// and "file-write".
Status writeDepfile(const DepfileArguments& arguments, std::span<const std::string> dependencies);

}  // namespace glint::cli
