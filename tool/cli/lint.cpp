// glint lint: finds shapes of SPIR-V that are slow, and checks budgets.
#include "spirv/lint.h"

#include "base/files.h"
#include "cli/command_line.h"
#include "cli/commands.h"
#include "cli/lint_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>

namespace glint {

namespace {

struct Budget {
    std::int64_t limit = 0;
    CLI::Option* option = nullptr;  // owned by its command
    bool given() const {
        return option->count() > 0;
    }
};

struct LintArguments {
    std::vector<std::string> paths;
    Budget instructions;
    Budget textureFetches;
    Budget rayQueries;
    std::string malioc;
    std::string core;
};

Result<SpirvLint> lintFile(const std::filesystem::path& path) {
    const Result<Bytes> bytes = readFile(path);
    if (!bytes) {
        return bytes.error();
    }
    if (bytes->size() % sizeof(std::uint32_t) != 0) {
        return makeError("spirv-format", path.string(),
                         fmt::format("has {} bytes, which is no multiple of 4", bytes->size()),
                         "expected a SPIR-V module; this one may be cut short");
    }
    std::vector<std::uint32_t> words(bytes->size() / sizeof(std::uint32_t));
    if (!words.empty()) {
        std::memcpy(words.data(), bytes->data(), bytes->size());
    }
    return lintSpirv(words);
}

void checkBudget(const Budget& budget, std::uint32_t count, const char* rule, const char* what,
                 std::vector<LintFinding>& findings) {
    if (budget.given() && count > budget.limit) {
        findings.push_back({Severity::Error,
                            rule,
                            {},
                            fmt::format("has {} {}; the budget is {}", count, what, budget.limit),
                            "drop features or accuracy, or raise the budget"});
    }
}

void checkBudgets(const LintArguments& arguments, LintedModule& module) {
    const SpirvStatistics& it = module.lint->statistics;
    checkBudget(arguments.instructions, it.instructions, "budget-instructions", "instructions",
                module.findings);
    checkBudget(arguments.textureFetches, it.textureFetches, "budget-texture-fetches", "texture fetches",
                module.findings);
    checkBudget(arguments.rayQueries, it.rayQueries, "budget-ray-queries", "ray queries", module.findings);
}

// Makes a finding of an error, with `severity` instead of the error's own.
LintFinding toFinding(const Diagnostic& error, Severity severity) {
    return {severity, error.id, {}, error.message, error.hint};
}

bool isStage(const LintedModule& module, const char* stage) {
    return module.lint && std::ranges::find(module.lint->stages, stage) != module.lint->stages.end();
}

LintedModule lintModule(const LintArguments& arguments, const LintReport& report, const LintFile& file) {
    LintedModule module;
    module.file = file;
    Result<SpirvLint> lint = lintFile(file.path);
    if (!lint) {
        module.findings.push_back(toFinding(lint.error(), Severity::Error));
        return module;
    }
    module.lint = std::move(*lint);
    module.findings = module.lint->findings;
    checkBudgets(arguments, module);
    if (report.malioc && isStage(module, "GLCompute")) {
        Result<MaliocReport> estimate = runMalioc(*report.malioc, arguments.core, file.path);
        if (estimate) {
            module.malioc = std::move(*estimate);
        } else {
            module.findings.push_back(toFinding(estimate.error(), Severity::Warning));
        }
    }
    return module;
}

// Judges a folder's modules together: a pipeline with many closest-hit shaders.
std::vector<LintFinding> judgeTogether(std::span<const LintedModule> modules) {
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

// Removes the findings that -W drops, and turns those into errors that it and --werror name.
void judge(const DiagnosticPolicy& policy, std::vector<LintFinding>& findings) {
    std::erase_if(findings, [&](LintFinding& finding) {
        const std::optional<Severity> severity = policy.judge(finding.severity, finding.rule);
        finding.severity = severity.value_or(finding.severity);
        return !severity;
    });
}

void reportFindings(const Console& console, const std::vector<LintFinding>& findings,
                    const std::string& where) {
    for (const LintFinding& finding : findings) {
        console.report(toDiagnostic(finding, where));
    }
}

// Lints the files that `path` stands for, and adds the results to `report`.
Status lintPath(const Console& console, const LintArguments& arguments, const std::string& path,
                LintReport& report) {
    const Result<LintFiles> files = findLintFiles(path);
    if (!files) {
        return files.error();
    }
    const std::size_t begin = report.modules.size();
    for (const LintFile& file : files->files) {
        console.progress(fmt::format("lint {}", file.path.string()));
        report.modules.push_back(lintModule(arguments, report, file));
    }
    if (files->isFolder) {
        report.folders.push_back({path, judgeTogether(std::span(report.modules).subspan(begin))});
    }
    return okStatus();
}

int lint(const Console& console, const LintArguments& arguments) {
    LintReport report;
    report.malioc = findProgram(arguments.malioc.empty() ? "malioc" : arguments.malioc);
    if (!report.malioc && !arguments.malioc.empty()) {
        console.report(makeError("malioc", arguments.malioc, "is not a program that can be run"));
        return kExitFailed;
    }
    for (const std::string& path : arguments.paths) {
        if (Status linted = lintPath(console, arguments, path, report); !linted) {
            console.report(linted.error());
            return kExitFailed;
        }
    }
    for (LintedModule& module : report.modules) {
        judge(console.policy(), module.findings);
        reportFindings(console, module.findings, module.file.path.string());
    }
    for (LintedFolder& folder : report.folders) {
        judge(console.policy(), folder.findings);
        reportFindings(console, folder.findings, folder.path);
    }
    if (console.isJson()) {
        console.result(toJson(report));
    } else {
        console.print(toText(report, console.isVerbose() ? Detail::Whole : Detail::Short));
    }
    return report.count(Severity::Error) > 0 ? kExitFailed : kExitDone;
}

void addBudget(CLI::App& command, const std::string& flag, Budget& budget, const std::string& what) {
    auto& option = addInteger(command, flag, budget.limit, 0, std::numeric_limits<std::int32_t>::max(), "");
    option.description(
        fmt::format("report an error above N {} in a module (from 0;\n"
                    "default: no limit)",
                    what));
    option.group("Budgets");
    budget.option = &option;
}

}  // namespace

void addLint(CLI::App& app, Action& chosen) {
    auto arguments = std::make_shared<LintArguments>();
    CLI::App& command =
        addCommand(app, "lint", "Find what is slow on mobile GPUs in SPIR-V, and check budgets",
                   "glint lint scene.glint --max-texture-fetches 12 --werror");
    command.add_option("PATH", arguments->paths, "SPIR-V files, packages, or folders of .spv files")
        ->type_name("FILE|DIR")
        ->required()
        ->check(CLI::Validator(
            [](const std::string& text) { return text.empty() ? std::string("is empty") : std::string(); },
            ""));
    addBudget(command, "--max-instructions", arguments->instructions, "instructions");
    addBudget(command, "--max-texture-fetches", arguments->textureFetches, "texture fetches");
    addBudget(command, "--max-ray-queries", arguments->rayQueries, "ray queries");
    addText(command, "--malioc", arguments->malioc, "PROGRAM",
            "Arm's Mali Offline Compiler, for cycles and registers\nof compute shaders (default: malioc, if "
            "PATH has "
            "it)");
    addText(command, "--core", arguments->core, "NAME",
            "the GPU that malioc compiles for (default: malioc's)");
    command.callback([arguments, &chosen] {
        chosen = [arguments](const Console& console) { return lint(console, *arguments); };
    });
}

}  // namespace glint
