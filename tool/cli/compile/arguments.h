// The command line of `glint compile`.
#pragma once

#include "cli/cache.h"
#include "cli/options/setting_options.h"
#include "emit/build_files.h"

#include <CLI/CLI.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace glint::cli {

struct CompileArguments {
    std::vector<std::string> scenes;
    std::string output;
    std::string embed;  // a C++ source; empty: none
    compiler::Settings settings;
    std::vector<std::string> emit{"header"};
    CacheArguments cache;
    compiler::Depfile depfile;
    std::string settingsFile;              // that completeLine() has read; empty: none
    std::string options;                   // all that are given, see describeOptions()
    std::vector<std::string> words;        // those that decide about the package, one a word
    std::vector<std::string> reportWords;  // those that decide which diagnostics are errors
    compiler::PlanFolder planOnly;         // empty: no plan
    std::string launcher;                  // of the plan's compilations
    std::string modules;                   // folder of compiled modules; empty: they are compiled
    bool dryRun = false;
    bool watch = false;
    bool early = true;              // early packages of a watch
    std::vector<std::string> line;  // the command line, without the program; for --watch
};

void addCompileOptions(CLI::App& command, CompileArguments& arguments);
// Returns an error if what the command is to write can't be written. Leaves nothing behind.
Status checkOutputs(const CompileArguments& arguments);
// Fills in the members that follow from the parsed `command`. Throws a CLI::ParseError if options contradict
// each other.
void finishCompile(const CLI::App& command, CompileArguments& arguments);

// Returns the settings with what else the package is to contain.
compiler::Settings settingsOf(const CompileArguments& arguments);

// Returns the files that stand for the whole output: the manifest, and those of --embed.
std::vector<std::string> mainOutputs(const CompileArguments& arguments);
// Returns the files that are read besides scenes.
std::vector<std::filesystem::path> furtherInputs(const CompileArguments& arguments);

}  // namespace glint::cli
