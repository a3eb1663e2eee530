// The `glint` command: subcommands, options, exit codes.
#pragma once

#include "cli/console.h"

#include <glint/result.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace glint::view {
struct Request;
}  // namespace glint::view

namespace glint::cli {

// The work of a program beside glint, which takes the same command line. glint itself has neither function,
// and starts that program.
struct Companion {
    // Opens a window and returns when it is closed. Of glint-view.
    Status (*showWindow)(const view::Request& request) = nullptr;
    // Does `glint check-materials --prove` for the folders of packs, with at most so many boxes of inputs for
    // each feature, and returns the exit code. Of glint-verify.
    int (*proveMaterials)(const Console& console, const std::vector<std::string>& packs,
                          std::uint64_t boxes) = nullptr;
};

// Becomes the program of that name beside this one, with the same command line. Returns only if that fails:
// `missing`.
Diagnostic startCompanion(const char* program, std::span<const char* const> line, const Diagnostic& missing);

// Parses the command line and does what it says. Results go to stdout, diagnostics to stderr.
int runCommandLine(int argc, const char* const* argv, const Companion& companion = {});

}  // namespace glint::cli
