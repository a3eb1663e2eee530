#include "base/clock.h"
#include "base/files.h"
#include "base/lists.h"
#include "cli/compile/compile.h"
#include "cli/options/options.h"
#include "emit/package/compiled_package.h"

#include <glint/package.h>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <iterator>
#include <set>
#include <system_error>
#include <utility>

namespace glint::cli {

namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds kPause(25);  // between two polls
constexpr std::size_t kNamed = 3;                // files that a line names

// Signal handlers can only reach global data.
volatile std::sig_atomic_t interrupted = 0;
volatile std::sig_atomic_t heldSignal = 0;

void interrupt(int /*signal*/) {
    interrupted = 1;
}

void hold(int signal) {
    heldSignal = signal;
}

// Parses the command line once more, with the settings file as it is now.
Result<CompileArguments> parseAgain(const std::vector<std::string>& line) {
    CLI::App app;
    CompileArguments arguments;
    CLI::App& command = addCommand(app, {.name = "compile"});
    addCompileOptions(command, arguments);
    ReportArguments report;
    addReportOptions(command, report);
    const auto pointers =
        base::mapped<const char*>(line, [](const std::string& word) { return word.c_str(); });
    GLINT_TRY(const auto completed, completeLine(app, pointers));
    try {
        std::vector<std::string> words(completed.words.rbegin(), completed.words.rend());
        app.parse(words);
        finishCompile(command, arguments);
    } catch (const CLI::ParseError& error) {
        const std::string message = explain(error, command);
        const std::optional<Diagnostic> ofFile = blameFile(completed, message);
        return ofFile ? *ofFile : makeError("settings-file", "", message);
    }
    arguments.line = line;
    return arguments;
}

// Returns the files that a run reads, as far as they are known before it.
std::vector<std::string> knownInputs(const CompileArguments& arguments) {
    std::vector<std::string> paths = arguments.scenes;
    for (const fs::path& file : furtherInputs(arguments)) {
        paths.push_back(file.string());
    }
    return paths;
}

// Returns the folders in which packs and the host may have files, each with the time when an entry came or
// went last.
using FolderTimes = std::vector<std::pair<std::string, fs::file_time_type>>;

FolderTimes timesOfFolders(const CompileArguments& arguments) {
    std::vector<std::string> roots = arguments.settings.materials;
    roots.push_back(arguments.settings.compile.host);
    FolderTimes times;
    std::erase(roots, "");
    for (const std::string& root : roots) {
        std::error_code error;
        times.emplace_back(root, fs::last_write_time(root, error));
        for (const fs::directory_entry& entry : fs::directory_iterator(root, error)) {
            if (entry.is_directory(error)) {
                times.emplace_back(entry.path().string(), entry.last_write_time(error));
            }
        }
    }
    return times;
}

// Returns whether entries that come or go now change the times: clocks of file systems may be coarse.
bool areSettled(const FolderTimes& times) {
    constexpr std::chrono::seconds kCoarsest(4);
    const auto latest = fs::file_time_type::clock::now() - kCoarsest;
    return std::ranges::all_of(times, [&](const auto& folder) { return folder.second < latest; });
}

// A failed run may have needed a file that comes later.
std::vector<std::string> sceneFolders(const CompileArguments& arguments) {
    std::vector<std::string> folders;
    for (const std::string& scene : arguments.scenes) {
        const fs::path folder = fs::path(scene).parent_path();
        folders.push_back(folder.empty() ? "." : folder.string());
    }
    return folders;
}

// A folder only says that some file came or went.
std::vector<std::string> withoutFolders(std::vector<std::string> changed) {
    std::vector<std::string> files;
    std::error_code error;
    std::ranges::copy_if(changed, std::back_inserter(files),
                         [&](const std::string& path) { return !fs::is_directory(path, error); });
    return files.empty() ? changed : files;
}

std::uint64_t hashOfTables(const compiler::CompiledPackage& package) {
    const auto tables = std::ranges::find(package.files, package::kTablesFile, &compiler::PackageFile::name);
    return tables == package.files.end() ? 0 : tables->hash;
}

class Watch {
public:
    Watch(const Console& console, const CompileArguments& arguments, const CompileOnce& compileOnce)
        : console_(console), arguments_(arguments), compileOnce_(compileOnce) {}

    void run() {
        watchFiles(true);
        compile("first run", {});
        while (interrupted == 0) {
            if (!watch_.wait(kPause)) {
                continue;
            }
            std::vector<std::string> changed = watch_.changed();
            if (changed.empty()) {
                changed = newOrGone();
            }
            if (!changed.empty() && interrupted == 0) {
                takeSettings(changed);
                compile(base::firstOf(withoutFolders(changed), kNamed), changed);
            }
        }
    }

private:
    void watchFiles(bool failed) {
        std::vector<base::InputFile> inputs = inputs_;
        const auto add = [&](const std::vector<std::string>& paths) {
            for (const std::string& path : paths) {
                inputs.push_back({path, std::nullopt});
            }
        };
        listed_ = knownInputs(arguments_);
        add(listed_);
        if (failed) {
            add(sceneFolders(arguments_));
        }
        std::set<std::string> folders(arguments_.settings.materials.begin(),
                                      arguments_.settings.materials.end());
        folders.insert(arguments_.settings.compile.host);
        folders.erase("");
        watch_.watch(inputs, std::move(folders));
    }

    // Returns the files of packs and hosts that have come or gone, once that has lasted.
    std::vector<std::string> newOrGone() {
        // The files themselves are many.
        FolderTimes times = timesOfFolders(arguments_);
        std::vector<fs::path> others = otherInputs(arguments_);
        if (times == times_ && others == others_ && areSettled(times)) {
            return {};
        }
        const std::vector<std::string> now = knownInputs(arguments_);
        if (now == listed_) {
            differs_.reset();
            times_ = std::move(times);
            others_ = std::move(others);
            return {};
        }
        differs_ = differs_.value_or(base::Clock::now());
        if (base::millisecondsSince(*differs_) < base::InputWatch::kMissingMs) {
            return {};
        }
        differs_.reset();
        const std::set<std::string> before(listed_.begin(), listed_.end());
        const std::set<std::string> after(now.begin(), now.end());
        std::vector<std::string> changed;
        std::ranges::set_symmetric_difference(before, after, std::back_inserter(changed));
        return changed;
    }

    void takeSettings(const std::vector<std::string>& changed) {
        const std::string& file = arguments_.settingsFile;
        if (file.empty() || std::ranges::find(changed, file) == changed.end()) {
            return;
        }
        Result<CompileArguments> again = parseAgain(arguments_.line);
        if (again) {
            arguments_ = std::move(*again);
        }
        settingsError_ = again ? std::nullopt : std::optional(again.error());
    }

    void compile(const std::string& why, std::vector<std::string> changed) {
        const base::Clock::time_point start = base::Clock::now();
        // Warnings that count as errors are those of this run.
        const Console own(console_.options());
        WatchedRun run(warm_, written_, std::move(changed), std::move(resolved_));
        bool done = false;
        if (settingsError_) {
            own.report(*settingsError_);
        } else {
            const Result<int> code = compileOnce_(own, arguments_, run);
            done = code && *code == kExitDone;
            resolved_ = std::move(run.resolved);
            if (!code) {
                own.report(code.error());
            }
        }
        warm_.endRun();
        if (!run.inputs.empty()) {
            inputs_ = run.inputs;
        }
        watchFiles(!done);
        if (!arguments_.settings.lock.file.empty()) {
            watch_.accept(arguments_.settings.lock.file);
        }
        bool fresh = false;
        if (done) {
            const Result<bool> counted = countUp(run.tables);
            if (!counted) {
                own.report(counted.error());
            }
            fresh = counted && *counted;
        }
        ++runs_;
        const double milliseconds = base::millisecondsSince(start);
        console_.print(
            fmt::format("{}. {}: {}\n", runs_, why,
                        done ? describe(run, fresh, milliseconds)
                             : fmt::format("failed, the package stays as it was; {:.0f} ms", milliseconds)));
        std::fflush(stdout);
    }

    static std::string describe(const WatchedRun& run, bool fresh, double milliseconds) {
        return fmt::format(
            "{}; cases: {} compiled, {} kept; other modules: {} compiled, {} kept{}; {:.0f} ms: "
            "read {:.0f}, plan {:.0f}, compile {:.0f}, write {:.0f}",
            fresh ? "new package" : "same package", run.casesCompiled, run.cases - run.casesCompiled,
            run.modulesCompiled, run.modules - run.modulesCompiled,
            run.parts == 0 ? std::string()
                           : fmt::format("; parts: {} compiled, {} kept", run.partsCompiled,
                                         run.parts - run.partsCompiled),
            milliseconds, run.readMs, run.planMs, run.compileMs, run.writeMs);
    }

    // Counts the stamp up if the package is not the one that it is about. Returns whether it did.
    Result<bool> countUp(std::uint64_t tables) const {
        const fs::path file = package::stampFile(arguments_.output);
        const std::string hash = base::hexHash(tables);
        if (const Result<base::Bytes> bytes = base::readFile(file);
            bytes && base::asText(*bytes).ends_with(" " + hash + "\n")) {
            return false;
        }
        const std::uint64_t counter = package::readStamp(file).value_or(0) + 1;
        GLINT_TRY_DO(base::writeFile(file, fmt::format("{} {}\n", counter, hash)));
        return true;
    }

    const Console& console_;
    CompileArguments arguments_;
    const CompileOnce& compileOnce_;
    compiler::WarmModules warm_;
    compiler::WrittenPackage written_;
    std::unique_ptr<Resolved> resolved_;  // of the last run, if that came so far
    base::InputWatch watch_;
    std::vector<base::InputFile> inputs_;  // of the last run that knew them
    std::vector<std::string> listed_;      // knownInputs() at the last run
    // Before listed_ was last found to be complete.
    FolderTimes times_;
    std::vector<fs::path> others_;                    // otherInputs()
    std::optional<base::Clock::time_point> differs_;  // since when others are there
    std::optional<Diagnostic> settingsError_;
    int runs_ = 0;
};

}  // namespace

void describeRun(const compiler::CompiledPackage& package, WatchedRun& run) {
    std::set<std::uint32_t> cases;
    std::set<std::uint32_t> compiled;
    for (const compiler::CompiledModule& module : package.modules) {
        if (package::findRole(module.key.role)->repeated == package::Repeated::ByCase) {
            cases.insert(module.key.index);
            if (module.compiled) {
                compiled.insert(module.key.index);
            }
        } else {
            ++run.modules;
            run.modulesCompiled += module.compiled ? 1 : 0;
        }
        run.parts += module.partsCompiled + module.partsCached;
        run.partsCompiled += module.partsCompiled;
    }
    run.tables = hashOfTables(package);
    run.cases = static_cast<int>(cases.size());
    run.casesCompiled = static_cast<int>(compiled.size());
    run.planMs = package.planMs;
    run.compileMs = package.compileMs;
}

SignalHandler::SignalHandler(std::initializer_list<int> signals, void (*handler)(int), int flags) {
    struct sigaction action {};
    action.sa_handler = handler;
    action.sa_flags = flags;
    sigemptyset(&action.sa_mask);
    for (const int signal : signals) {
        sigaction(signal, &action, &earlier_.emplace_back(signal, action).second);
    }
}

SignalHandler::~SignalHandler() {
    for (const auto& [signal, earlier] : earlier_) {
        sigaction(signal, &earlier, nullptr);
    }
}

HeldSignals::HeldSignals() {
    heldSignal = 0;
    handler_.emplace(std::initializer_list<int>{SIGINT, SIGTERM, SIGHUP}, hold, SA_RESTART);
}

HeldSignals::~HeldSignals() {
    handler_.reset();
    if (heldSignal != 0) {
        std::raise(heldSignal);
    }
}

int watchInputs(const Console& console, const CompileArguments& arguments, const CompileOnce& compileOnce) {
    interrupted = 0;
    // The first signal ends the watch. A second one has its usual effect, so that a long compilation can be
    // ended.
    const SignalHandler handler({SIGINT, SIGTERM}, interrupt, static_cast<int>(SA_RESETHAND | SA_RESTART));
    Watch(console, arguments, compileOnce).run();
    return kExitDone;
}

}  // namespace glint::cli
