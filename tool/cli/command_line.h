// The `glint` command: subcommands, options, exit codes.
#pragma once

#include "cli/console.h"

#include <glint/result.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace CLI {  // NOLINT(readability-identifier-naming): CLI11's
class App;
}  // namespace CLI

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

// The subcommands. Each declares its options. If the command line names it, it sets `chosen` to its work.
// `line` has the words of the command line, without the program.
void addCompile(CLI::App& app, Action& chosen, std::span<const char* const> line);
void addCompileModule(CLI::App& app, Action& chosen);
void addExplain(CLI::App& app, Action& chosen);
void addInspect(CLI::App& app, Action& chosen);
void addDiff(CLI::App& app, Action& chosen);
void addLint(CLI::App& app, Action& chosen);
void addRender(CLI::App& app, Action& chosen);
void addView(CLI::App& app, Action& chosen, std::span<const char* const> line, const Companion& companion);
void addBench(CLI::App& app, Action& chosen);
void addCompare(CLI::App& app, Action& chosen);
void addCheckMaterials(CLI::App& app, Action& chosen, std::span<const char* const> line,
                       const Companion& companion);
// Call this after all other commands are added, because the script is made from their options.
void addCompletion(CLI::App& app, Action& chosen);

// Parses the command line, does what it says, and returns the exit code. Results go to stdout, diagnostics to
// stderr. Throws nothing.
int runCommandLine(int argc, const char* const* argv, const Companion& companion = {});

}  // namespace glint::cli
