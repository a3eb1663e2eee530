// The parts of glint compile: its command line, its summary, and its watch.
#pragma once

#include "base/input_watch.h"
#include "cli/cache.h"
#include "cli/console.h"
#include "cli/options/setting_options.h"
#include "cli/report.h"
#include "emit/compile.h"
#include "emit/module_files.h"
#include "emit/package/compiled_package.h"
#include "emit/warm_modules.h"
#include "gltf/import_options.h"
#include "gltf/scene.h"
#include "resolve/build.h"

#include <CLI/CLI.hpp>

#include <csignal>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
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
    std::string modules;                   // CompileSettings::modules
    bool dryRun = false;
    bool watch = false;
    std::vector<std::string> line;  // the command line, without the program; for --watch
};

void addCompileOptions(CLI::App& command, CompileArguments& arguments);
// Returns an error if what the command is to write can't be written. Leaves nothing behind.
Status checkOutputs(const CompileArguments& arguments);
// Fills in the members that follow from the parsed `command`. Throws a CLI::ParseError if options contradict
// each other.
void finishCompile(const CLI::App& command, CompileArguments& arguments);

// Returns the files that stand for the whole output: the manifest, and those of --embed.
std::vector<std::string> mainOutputs(const CompileArguments& arguments);
// Returns the files that are read besides scenes and packs.
std::vector<std::filesystem::path> otherInputs(const CompileArguments& arguments);
// Returns these together with the files of packs.
std::vector<std::filesystem::path> furtherInputs(const CompileArguments& arguments);

// --- The text that `compile` prints at the end of a run, and again if a run has nothing to do ---

// Moving the Json can't throw here. NOLINTNEXTLINE(bugprone-exception-escape)
struct CompileSummary {
    base::Json json;
    Rows fields;          // name and value; the last is the output
    std::string dropped;  // text below the fields
    int modules = 0;      // of the package
};

// The numbers of a package's modules; absent after a dry run.
struct ModuleCounts {
    int compiled = 0;
    int cached = 0;  // or with the text of another
    // These count the parts of the modules that were joined in this run.
    int partsCompiled = 0;
    int partsCached = 0;
};

ModuleCounts countModules(const compiler::CompiledPackage& package);

// Adds `milliseconds`, `modules` and `upToDate`, and prints the summary. The JSON already has places for
// these members.
void tell(const Console& console, CompileSummary summary, const std::optional<ModuleCounts>& modules,
          bool upToDate, double milliseconds);

std::string pack(const CompileSummary& summary);
// Returns nothing if `bytes` is not a summary. Without `withJson` the JSON stays empty; parsing it takes time
// that grows with the scene.
std::optional<CompileSummary> unpackSummary(std::string_view bytes, bool withJson);

// --- glint compile --watch: compiles again when an input changes ---

// The scenes of a run, and all decisions about them.
struct Resolved {
    gltf::ImportOptions import;
    std::vector<gltf::Scene> scenes;
    compiler::Build build;
    std::vector<Diagnostic> diagnostics;  // about them
};

// The data that the watch and one run of the compiler exchange.
struct WatchedRun {
    WatchedRun(compiler::WarmModules& memory, compiler::WrittenPackage& output,
               std::vector<std::string> files, std::unique_ptr<Resolved> earlier)
        : warm(memory), written(output), changed(std::move(files)), resolved(std::move(earlier)) {}

    compiler::WarmModules& warm;
    compiler::WrittenPackage& written;
    std::vector<std::string> changed;    // since the run before this one
    std::unique_ptr<Resolved> resolved;  // before a run, that of the one before; null if it has none
    // The files that were read; empty if the run failed before it knew them.
    std::vector<base::InputFile> inputs;
    // Wall clock: reading and checking, planning and making GLSL, making SPIR-V, and making and writing
    // files.
    double readMs = 0.0;
    double planMs = 0.0;
    double compileMs = 0.0;
    double writeMs = 0.0;
    int cases = 0;          // with shaders of their own
    int casesCompiled = 0;  // those of which a module was compiled
    int modules = 0;        // other modules
    int modulesCompiled = 0;
    int parts = 0;  // of modules that were joined
    int partsCompiled = 0;
    std::uint64_t tables = 0;  // hash of tables.bin, which has the hashes of all modules
};

// Sets the counts and times of a package that was compiled.
void describeRun(const compiler::CompiledPackage& package, WatchedRun& run);

// While it lives, signals have another handler.
class SignalHandler {
public:
    SignalHandler(std::initializer_list<int> signals, void (*handler)(int), int flags);
    SignalHandler(const SignalHandler&) = delete;
    SignalHandler& operator=(const SignalHandler&) = delete;
    ~SignalHandler();

private:
    std::vector<std::pair<int, struct sigaction>> earlier_;
};

// While it lives, SIGINT, SIGTERM and SIGHUP wait, because files are being replaced. Afterwards the last one
// that came has its usual effect. Use it for short stretches, and only one at a time: the command acts on one
// thread.
class HeldSignals {
public:
    HeldSignals();
    HeldSignals(const HeldSignals&) = delete;
    HeldSignals& operator=(const HeldSignals&) = delete;
    ~HeldSignals();

private:
    std::optional<SignalHandler> handler_;
};

// Calls `compileOnce`, which returns an exit code or the error of the run, at the start and after each change
// of an input, until SIGINT or SIGTERM. After each run it prints a line, and after each new package it counts
// the stamp up (glint/package.h). Returns the exit code of the command, which is 0.
using CompileOnce = std::function<Result<int>(const Console&, const CompileArguments&, WatchedRun&)>;
int watchInputs(const Console& console, const CompileArguments& arguments, const CompileOnce& compileOnce);

}  // namespace glint::cli
