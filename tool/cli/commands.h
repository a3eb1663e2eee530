// The subcommands. Each declares its options. If the command line names it, it sets `chosen` to its work.
#pragma once

#include "cli/options/options.h"

#include <CLI/CLI.hpp>

#include <span>

namespace glint::cli {

struct Companion;

// `line` has the words of the command line, without the program.
void addCompile(CLI::App& app, Action& chosen, std::span<const char* const> line);
void addCompileModule(CLI::App& app, Action& chosen);
void addExplain(CLI::App& app, Action& chosen);
void addInspect(CLI::App& app, Action& chosen);
void addDiff(CLI::App& app, Action& chosen);
void addLint(CLI::App& app, Action& chosen);
void addRender(CLI::App& app, Action& chosen);
// `line` and `companion` are as in addCompile() and runCommandLine().
void addView(CLI::App& app, Action& chosen, std::span<const char* const> line, const Companion& companion);
void addBench(CLI::App& app, Action& chosen);
void addCompare(CLI::App& app, Action& chosen);
void addCheckMaterials(CLI::App& app, Action& chosen, std::span<const char* const> line,
                       const Companion& companion);
// Call this after all other commands are added, because the script is made from their options.
void addCompletion(CLI::App& app, Action& chosen);

}  // namespace glint::cli
