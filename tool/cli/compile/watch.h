// glint compile --watch: compiles again when an input changes.
#pragma once

#include "base/input_watch.h"
#include "cli/compile/arguments.h"
#include "cli/console.h"
#include "emit/compile.h"
#include "emit/warm_modules.h"

#include <csignal>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace glint::cli {

// The data that the watch and one run of the compiler exchange.
struct WatchedRun {
    explicit WatchedRun(compiler::WarmModules& memory) : warm(memory) {}

    compiler::WarmModules& warm;
    // How the run may show an edit before the whole package is compiled.
    std::optional<compiler::EarlyShowing> showing;
    // The whole package that the run has written.
    std::optional<compiler::CompiledPackage> made;
    bool outdated = false;  // the run ended early, because an input changed
    // The files that were read; empty if the run failed before it knew them.
    std::vector<base::InputFile> inputs;
    // Wall clock: reading and checking, planning and making GLSL, making SPIR-V, and making and writing
    // files.
    double readMs = 0.0;
    double earlyMs = 0.0;  // of the early package, without reading and planning; 0: there is none
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
