#include "inspect/lint.h"

#include "base/files.h"
#include "base/json.h"
#include "base/lists.h"

#include <glint/internal/package_format.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <set>
#include <spawn.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>

extern char** environ;

namespace glint::inspect {

namespace fs = std::filesystem;

namespace {

using MaliocJson = nlohmann::json;

constexpr const char* kHint = "run it by hand on this file";

Diagnostic maliocError(const fs::path& where, const std::string& message) {
    return makeError("malioc", where.string(), message, kHint);
}

// Returns the value at a JSON pointer, or null if there is none.
const MaliocJson& at(const MaliocJson& json, const char* pointer) {
    static const MaliocJson null;
    const MaliocJson::json_pointer place(pointer);
    return json.contains(place) ? json.at(place) : null;
}

std::string textOf(const MaliocJson& value) {
    return value.is_string() ? value.get<std::string>() : std::string();
}

std::optional<std::int64_t> integerOf(const MaliocJson& value) {
    constexpr double kLimit = 1e15;
    const double number = value.is_number() ? value.get<double>() : std::nan("");
    return std::abs(number) < kLimit ? std::optional(std::llround(number)) : std::nullopt;
}

// Returns the value of a name in a list of {"name", "value"}.
const MaliocJson& property(const MaliocJson& properties, std::string_view name) {
    static const MaliocJson null;
    if (properties.is_array()) {
        for (const MaliocJson& it : properties) {
            if (textOf(at(it, "/name")) == name) {
                return at(it, "/value");
            }
        }
    }
    return null;
}

void readCycles(const MaliocJson& performance, MaliocReport& report) {
    const MaliocJson& pipelines = at(performance, "/pipelines");
    const MaliocJson& counts = at(performance, "/longest_path_cycles/cycle_count");
    if (pipelines.is_array() && counts.is_array()) {
        for (std::size_t i = 0; i < std::min(pipelines.size(), counts.size()); ++i) {
            // A path without a bound is null.
            if (counts[i].is_number() && pipelines[i].is_string()) {
                const auto cycles = counts[i].get<double>();
                report.cycles[textOf(pipelines[i])] = cycles;
                report.longestCycles = std::max(report.longestCycles.value_or(cycles), cycles);
            }
        }
    }
    if (const MaliocJson& bound = at(performance, "/longest_path_cycles/bound_pipelines"); bound.is_array()) {
        for (const MaliocJson& pipeline : bound) {
            if (pipeline.is_string()) {
                report.boundPipelines.push_back(textOf(pipeline));
            }
        }
    }
}

// The output of the program that `arguments` run, including its errors.
struct ProgramOutput {
    int error = 0;  // errno, where it could not be run
    int status = 0;
    std::string text;
};

ProgramOutput runProgram(std::vector<std::string> arguments) {
    std::array<int, 2> pipe{};
    if (::pipe(pipe.data()) != 0) {
        return {errno, 0, {}};
    }
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addclose(&actions, pipe[0]);
    posix_spawn_file_actions_adddup2(&actions, pipe[1], STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, pipe[1], STDERR_FILENO);
    posix_spawn_file_actions_addclose(&actions, pipe[1]);
    std::vector<char*> pointers;
    pointers.reserve(arguments.size() + 1);
    for (std::string& argument : arguments) {
        pointers.push_back(argument.data());
    }
    pointers.push_back(nullptr);
    pid_t child = 0;
    ProgramOutput output;
    output.error = posix_spawn(&child, pointers[0], &actions, nullptr, pointers.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(pipe[1]);
    if (output.error == 0) {
        std::array<char, 4096> buffer{};
        for (ssize_t count = 1; count > 0 || (count < 0 && errno == EINTR);) {
            count = read(pipe[0], buffer.data(), buffer.size());
            output.text.append(buffer.data(), count > 0 ? static_cast<std::size_t>(count) : 0);
        }
        while (waitpid(child, &output.status, 0) < 0 && errno == EINTR) {
        }
    }
    close(pipe[0]);
    return output;
}

bool isRunnable(const fs::path& path) {
    std::error_code error;
    return fs::is_regular_file(path, error) && access(path.c_str(), X_OK) == 0;
}

}  // namespace

std::optional<fs::path> findProgram(const std::string& program) {
    if (program.find('/') != std::string::npos) {
        return isRunnable(program) ? std::optional<fs::path>(program) : std::nullopt;
    }
    const char* const variable = std::getenv("PATH");
    const std::string path = variable == nullptr ? "" : variable;
    for (std::size_t begin = 0; begin <= path.size();) {
        const std::size_t end = std::min(path.find(':', begin), path.size());
        const std::string folder = path.substr(begin, end - begin);
        // An empty entry stands for the current folder (POSIX, 8.3).
        if (fs::path file = fs::path(folder.empty() ? "." : folder) / program; isRunnable(file)) {
            return file;
        }
        begin = end + 1;
    }
    return std::nullopt;
}

Result<MaliocReport> parseMalioc(std::string_view text) {
    const MaliocJson json = MaliocJson::parse(text, nullptr, false);
    const MaliocJson& shader = at(json, "/shaders/0");
    if (!shader.is_object()) {
        const std::string line(text.substr(0, text.find('\n')));
        return maliocError({}, "malioc printed no report: " + (line.empty() ? "nothing at all" : line));
    }
    if (const MaliocJson& error = at(shader, "/errors/0"); error.is_string()) {
        return maliocError({}, "malioc: " + textOf(error));
    }
    MaliocReport report;
    report.core = textOf(at(shader, "/hardware/core"));
    // A compute shader has one variant.
    readCycles(at(shader, "/variants/0/performance"), report);
    const MaliocJson& properties = at(shader, "/variants/0/properties");
    report.workRegisters = integerOf(property(properties, "work_registers_used"));
    report.occupancy = integerOf(property(properties, "thread_occupancy"));
    report.spillBytes = integerOf(property(properties, "stack_spill_bytes"));
    // This list belongs to the shader as a whole.
    for (const MaliocJson* const list : {&at(shader, "/properties"), &properties}) {
        if (const MaliocJson& slow = property(*list, "has_slow_ray_traversal"); slow.is_boolean()) {
            report.slowRayTraversal = slow.get<bool>();
        }
    }
    if (const MaliocJson& spills = property(properties, "has_stack_spilling"); spills.is_boolean()) {
        report.spills = spills.get<bool>();
    } else if (report.spillBytes) {
        report.spills = *report.spillBytes > 0;
    }
    return report;
}

Result<MaliocReport> runMalioc(const fs::path& program, const std::string& core, const fs::path& spirv) {
    std::vector<std::string> arguments{program.string(), "--vulkan", "--compute", "--format", "json"};
    if (!core.empty()) {
        arguments.insert(arguments.end(), {"--core", core});
    }
    // The path is absolute, so that no file is taken for an option.
    arguments.push_back(fs::absolute(spirv).string());
    const ProgramOutput output = runProgram(std::move(arguments));
    if (output.error != 0) {
        return maliocError(program, std::string("can't be run: ") + std::strerror(output.error));
    }
    Result<MaliocReport> report = parseMalioc(output.text);
    if (report && (!WIFEXITED(output.status) || WEXITSTATUS(output.status) != 0)) {
        return maliocError(spirv, "malioc failed");
    }
    return report ? report : maliocError(spirv, report.error().message);
}

namespace {

constexpr const char* kExtension = ".spv";

std::string textOf(const base::Json& object, const char* member) {
    const auto found = object.find(member);
    return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

// Finds every object with a "file" that is SPIR-V, wherever it is in the manifest, so that future strategies
// need no change here.
class ManifestWalk {
public:
    explicit ManifestWalk(fs::path folder) : folder_(std::move(folder)) {}

    void visit(const base::Json& value, const std::string& name) {
        if (value.is_array()) {
            for (const auto& element : value) {
                visit(element, name);
            }
        } else if (value.is_object()) {
            visitObject(value, name);
        }
    }
    std::vector<LintFile> take() {
        return std::move(files_);
    }

private:
    void visitObject(const base::Json& object, std::string name) {
        if (const std::string role = textOf(object, "role"); !role.empty()) {
            name = role;
        }
        const std::string file = textOf(object, "file");
        if (fs::path(file).extension() == kExtension && seen_.insert(file).second) {
            files_.push_back({folder_ / file, name});
        }
        const bool isShader = object.contains("stages");
        for (const auto& [key, member] : object.items()) {
            if (isShader && key == "stages" && member.is_object()) {
                for (const auto& [stage, module] : member.items()) {
                    visit(module, textOf(object, "name") + " " + stage);
                }
            } else {
                visit(member, name);
            }
        }
    }

    fs::path folder_;
    std::vector<LintFile> files_;
    std::set<std::string> seen_;
};

Result<std::vector<LintFile>> filesOfPackage(const fs::path& folder) {
    constexpr std::uint64_t kMostBytes = 1ULL << 32;
    base::JsonReader reader(folder / package::kManifestFile, "manifest-format", "compile the package again");
    GLINT_TRY(const auto manifest, reader.read(kMostBytes));
    ManifestWalk walk(folder);
    // The list of all files comes after those that have a name.
    walk.visit(manifest, "");
    return walk.take();
}

Result<std::vector<LintFile>> filesBelow(const fs::path& folder) {
    std::vector<LintFile> files;
    std::error_code error;
    for (fs::recursive_directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
        std::error_code ignored;
        if (it->path().extension() == kExtension && it->is_regular_file(ignored)) {
            files.push_back({it->path(), ""});
        }
    }
    if (error) {
        return makeError("lint-path", folder.string(), "can't be listed: " + error.message());
    }
    std::ranges::sort(files, {}, &LintFile::path);
    return files;
}

Result<compiler::SpirvLint> lintFile(const std::filesystem::path& path) {
    GLINT_TRY(const auto bytes, base::readFile(path));
    if (bytes.size() % sizeof(std::uint32_t) != 0) {
        return makeError("spirv-format", path.string(),
                         fmt::format("has {} bytes, which is no multiple of 4", bytes.size()),
                         "expected a SPIR-V module; this one may be cut short");
    }
    std::vector<std::uint32_t> words(bytes.size() / sizeof(std::uint32_t));
    if (!words.empty()) {
        std::memcpy(words.data(), bytes.data(), bytes.size());
    }
    return compiler::lintSpirv(words);
}

void checkBudget(const std::optional<std::int64_t>& budget, std::uint32_t count, const char* rule,
                 const char* what, std::vector<compiler::LintFinding>& findings) {
    if (budget && count > *budget) {
        findings.push_back({Severity::Error,
                            rule,
                            {},
                            fmt::format("has {} {}; the budget is {}", count, what, *budget),
                            "drop features or accuracy, or raise the budget"});
    }
}

void checkBudgets(const LintBudgets& budgets, LintedModule& module) {
    const compiler::SpirvStatistics& it = module.lint->statistics;
    checkBudget(budgets.instructions, it.instructions, "budget-instructions", "instructions",
                module.findings);
    checkBudget(budgets.textureFetches, it.textureFetches, "budget-texture-fetches", "texture fetches",
                module.findings);
    checkBudget(budgets.rayQueries, it.rayQueries, "budget-ray-queries", "ray queries", module.findings);
}

// Makes a finding of an error, with `severity` instead of the error's own.
compiler::LintFinding toFinding(const Diagnostic& error, Severity severity) {
    return {severity, error.id, {}, error.message, error.hint};
}

bool isStage(const LintedModule& module, const char* stage) {
    return module.lint && std::ranges::find(module.lint->stages, stage) != module.lint->stages.end();
}

}  // namespace

std::size_t countIn(const std::vector<compiler::LintFinding>& findings, Severity severity) {
    return static_cast<std::size_t>(std::ranges::count(findings, severity, &compiler::LintFinding::severity));
}

Result<LintFiles> findLintFiles(const fs::path& path) {
    std::error_code error;
    if (!fs::is_directory(path, error)) {
        if (!fs::exists(path, error)) {
            return makeError("lint-path", path.string(), "is not there",
                             "name a SPIR-V file, a package or a folder of SPIR-V files");
        }
        return LintFiles{false, {{path, ""}}};
    }
    GLINT_TRY(auto files,
              fs::exists(path / package::kManifestFile, error) ? filesOfPackage(path) : filesBelow(path));
    if (files.empty()) {
        return makeError("lint-path", path.string(), "holds no SPIR-V file",
                         "name a package or a folder of .spv files");
    }
    return LintFiles{true, std::move(files)};
}

LintedModule lintModule(const LintFile& file, const LintBudgets& budgets,
                        const std::optional<fs::path>& malioc, const std::string& core) {
    LintedModule module;
    module.file = file;
    Result<compiler::SpirvLint> lint = lintFile(file.path);
    if (!lint) {
        module.findings.push_back(toFinding(lint.error(), Severity::Error));
        return module;
    }
    module.lint = std::move(*lint);
    module.findings = module.lint->findings;
    checkBudgets(budgets, module);
    if (malioc && isStage(module, "GLCompute")) {
        Result<MaliocReport> estimate = runMalioc(*malioc, core, file.path);
        if (estimate) {
            module.malioc = std::move(*estimate);
        } else {
            module.findings.push_back(toFinding(estimate.error(), Severity::Warning));
        }
    }
    return module;
}

std::vector<compiler::LintFinding> judgeTogether(std::span<const LintedModule> modules) {
    // Mobile linkers inline the hit shaders of a pipeline up to about this number.
    constexpr std::ptrdiff_t kMaxClosestHits = 10;
    const auto closestHits = std::ranges::count_if(
        modules, [](const LintedModule& module) { return isStage(module, "ClosestHitKHR"); });
    if (closestHits <= kMaxClosestHits) {
        return {};
    }
    return {{Severity::Warning,
             "ray-pipeline-shaders",
             {},
             fmt::format("has {} closest-hit shaders; mobile drivers inline up to {}", closestHits,
                         kMaxClosestHits),
             "merge cases (--merge family or all), or use ray queries"}};
}

std::size_t LintReport::count(Severity severity) const {
    const auto countOf = [severity](const auto& linted) { return countIn(linted.findings, severity); };
    return base::sumOf<std::size_t>(modules, countOf) + base::sumOf<std::size_t>(folders, countOf);
}

Diagnostic toDiagnostic(const compiler::LintFinding& finding, const std::string& where) {
    const std::string place = toString(finding.place);
    return {finding.severity, finding.rule, where, (place.empty() ? "" : place + ": ") + finding.message,
            finding.hint};
}

}  // namespace glint::inspect
