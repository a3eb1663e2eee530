// glint lint: finds shapes of SPIR-V that are slow, and checks budgets.
#include "inspect/lint.h"

#include "cli/command_line.h"
#include "cli/options/options.h"
#include "cli/report.h"
#include "cli/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>

namespace glint::cli {

namespace {

base::Json findingsToJson(const std::vector<compiler::LintFinding>& findings, const std::string& where) {
    return listOf(findings, [&](const compiler::LintFinding& finding) {
        Diagnostic diagnostic = inspect::toDiagnostic(finding, where);
        diagnostic.message = finding.message;
        base::Json json = cli::toJson(diagnostic);
        json["function"] = base::textOrNull(finding.place.function);
        json["source"] = base::textOrNull(finding.place.source);
        json["resultId"] = finding.place.id == 0 ? base::Json(nullptr) : base::Json(finding.place.id);
        json["word"] = finding.place.offset == 0 ? base::Json(nullptr) : base::Json(finding.place.offset);
        return json;
    });
}

base::Json toJson(const inspect::MaliocReport& report) {
    return {{"core", base::textOrNull(report.core)},
            {"longestCycles", base::orNull(report.longestCycles)},
            {"boundPipelines", report.boundPipelines},
            {"cycles", report.cycles},
            {"workRegisters", base::orNull(report.workRegisters)},
            {"occupancy", base::orNull(report.occupancy)},
            {"spills", base::orNull(report.spills)},
            {"spillBytes", base::orNull(report.spillBytes)},
            {"slowRayTraversal", base::orNull(report.slowRayTraversal)}};
}

base::Json toJson(const compiler::SpirvStatistics& statistics) {
    return {{"bytes", statistics.bytes},
            {"instructions", statistics.instructions},
            {"textureFetches", statistics.textureFetches},
            {"rayQueries", statistics.rayQueries},
            {"traces", statistics.traces},
            {"functions", statistics.functions},
            {"branches", statistics.branches}};
}

base::Json toJson(const inspect::LintedModule& module) {
    return {{"file", module.file.path.string()},
            {"name", base::textOrNull(module.file.name)},
            {"stages", module.lint ? base::Json(module.lint->stages) : base::Json::array()},
            {"statistics", module.lint ? toJson(module.lint->statistics) : base::Json(nullptr)},
            {"malioc", module.malioc ? toJson(*module.malioc) : base::Json(nullptr)},
            {"findings", findingsToJson(module.findings, module.file.path.string())}};
}

std::vector<std::string> countsOf(const inspect::LintedModule& module) {
    if (!module.lint) {
        return {"-", "-", "-", "-", "-", "-"};
    }
    const compiler::SpirvStatistics& it = module.lint->statistics;
    return {base::join(module.lint->stages),      fmt::format("{}", it.instructions),
            fmt::format("{}", it.textureFetches), fmt::format("{}", it.rayQueries),
            fmt::format("{}", it.traces),         fmt::format("{}", it.functions)};
}

std::vector<std::string> cyclesOf(const inspect::LintedModule& module) {
    if (!module.malioc) {
        return {"-", "-", "-", "-", "-"};
    }
    const inspect::MaliocReport& it = *module.malioc;
    const std::string spills = it.spillBytes ? fmt::format("{}", *it.spillBytes)
                               : it.spills   ? (*it.spills ? "yes" : "no")
                                             : "-";
    return {it.longestCycles ? fmt::format("{:.2f}", *it.longestCycles) : "-", base::join(it.boundPipelines),
            it.workRegisters ? fmt::format("{}", *it.workRegisters) : "-", spills,
            it.slowRayTraversal ? (*it.slowRayTraversal ? "slow" : "fast") : "-"};
}

// Returns "-" for 0, so that other numbers stand out.
std::string nonZero(std::size_t count) {
    return count == 0 ? "-" : fmt::format("{}", count);
}

std::string summaryOf(const inspect::LintReport& report) {
    return fmt::format("\n{}: {}, {}, {}\n", base::counted(report.modules.size(), "module"),
                       base::counted(report.count(Severity::Error), "error"),
                       base::counted(report.count(Severity::Warning), "warning"),
                       base::counted(report.count(Severity::Note), "note")) +
           (report.malioc ? "" : "malioc not found: no cycle estimates\n");
}

// Names of modules are shown with Detail::Whole only, because their files are named after them.
std::string toText(const inspect::LintReport& report, Detail detail) {
    const auto isNamed = [](const inspect::LintedModule& module) { return !module.file.name.empty(); };
    const auto isEstimated = [](const inspect::LintedModule& module) { return module.malioc.has_value(); };
    // Files are named after their shaders, so the short table has their names alone.
    const bool hasNames = detail == Detail::Whole && std::ranges::any_of(report.modules, isNamed);
    const bool hasCycles = std::ranges::any_of(report.modules, isEstimated);
    Rows rows{{"file", "instructions", "fetches", "queries", "traces", "errors", "warnings"}};
    if (detail == Detail::Whole) {
        rows[0] = {"file",   "stage",     "instructions", "fetches", "queries",
                   "traces", "functions", "errors",       "warnings"};
    }
    if (hasNames) {
        rows[0].insert(rows[0].begin(), "module");
    }
    if (hasCycles) {
        rows[0].insert(rows[0].end(), {"cycles", "bound by", "registers", "spilled", "traversal"});
    }
    for (const inspect::LintedModule& module : report.modules) {
        std::vector<std::string> row;
        if (hasNames) {
            row.push_back(module.file.name);
        }
        // All files of a package are in its folder, so the file's name is enough.
        row.push_back(isNamed(module) ? module.file.path.filename().string() : module.file.path.string());
        std::vector<std::string> counts = countsOf(module);
        if (detail == Detail::Short) {
            // The file's name says the stage as well.
            counts.erase(counts.begin());
            counts.pop_back();
        }
        std::ranges::move(counts, std::back_inserter(row));
        row.push_back(nonZero(inspect::countIn(module.findings, Severity::Error)));
        row.push_back(nonZero(inspect::countIn(module.findings, Severity::Warning)));
        if (hasCycles) {
            std::ranges::move(cyclesOf(module), std::back_inserter(row));
        }
        rows.push_back(std::move(row));
    }
    return formatTable(rows, detail) + summaryOf(report);
}

// Returns the JSON that docs/lint.md describes.
base::Json toJson(const inspect::LintReport& report) {
    base::Json findings = base::Json::array();
    for (const inspect::LintedFolder& folder : report.folders) {
        for (base::Json& finding : findingsToJson(folder.findings, folder.path)) {
            findings.push_back(std::move(finding));
        }
    }
    return {{"modules", listOf(report.modules, [](const auto& module) { return toJson(module); })},
            {"findings", std::move(findings)},
            {"errors", report.count(Severity::Error)},
            {"warnings", report.count(Severity::Warning)},
            {"notes", report.count(Severity::Note)},
            {"malioc", report.malioc ? base::Json(report.malioc->string()) : base::Json(nullptr)}};
}

struct Budget {
    std::int64_t limit = 0;
    CLI::Option* option = nullptr;  // owned by its command
    std::optional<std::int64_t> value() const {
        return option->count() > 0 ? std::optional(limit) : std::nullopt;
    }
};

struct LintArguments {
    std::vector<std::string> paths;
    Budget instructions;
    Budget textureFetches;
    Budget rayQueries;
    std::string malioc;
    std::string core;

    inspect::LintBudgets budgets() const {
        return {instructions.value(), textureFetches.value(), rayQueries.value()};
    }
};

// Removes the findings that -W drops, and turns those into errors that it and --werror name.
void judge(const DiagnosticPolicy& policy, std::vector<compiler::LintFinding>& findings) {
    std::erase_if(findings, [&](compiler::LintFinding& finding) {
        const std::optional<Severity> severity = policy.judge(finding.severity, finding.rule);
        finding.severity = severity.value_or(finding.severity);
        return !severity;
    });
}

void reportFindings(const Console& console, const std::vector<compiler::LintFinding>& findings,
                    const std::string& where) {
    for (const compiler::LintFinding& finding : findings) {
        console.report(inspect::toDiagnostic(finding, where));
    }
}

// Lints the files that `path` stands for, and adds the results to `report`.
Status lintPath(const Console& console, const LintArguments& arguments, const std::string& path,
                inspect::LintReport& report) {
    GLINT_TRY(const auto files, inspect::findLintFiles(path));
    const std::size_t begin = report.modules.size();
    for (const inspect::LintFile& file : files.files) {
        console.progress(fmt::format("lint {} of {}: {}", report.modules.size() - begin + 1,
                                     files.files.size(), file.path.string()));
        report.modules.push_back(
            inspect::lintModule(file, arguments.budgets(), report.malioc, arguments.core));
    }
    if (files.isFolder) {
        report.folders.push_back({path, inspect::judgeTogether(std::span(report.modules).subspan(begin))});
    }
    return okStatus();
}

Result<int> lint(const Console& console, const LintArguments& arguments) {
    inspect::LintReport report;
    report.malioc = inspect::findProgram(arguments.malioc.empty() ? "malioc" : arguments.malioc);
    if (!report.malioc && !arguments.malioc.empty()) {
        return makeError("malioc", arguments.malioc, "is not a program that can be run");
    }
    for (const std::string& path : arguments.paths) {
        GLINT_TRY_DO(lintPath(console, arguments, path, report));
    }
    for (inspect::LintedModule& module : report.modules) {
        judge(console.policy(), module.findings);
        reportFindings(console, module.findings, module.file.path.string());
    }
    for (inspect::LintedFolder& folder : report.folders) {
        judge(console.policy(), folder.findings);
        reportFindings(console, folder.findings, folder.path);
    }
    answer(
        console, [&] { return toJson(report); }, [&](Detail detail) { return toText(report, detail); });
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
    CLI::App& command = addCommand(
        app,
        {.name = "lint",
         .what = "Find code in SPIR-V that is slow on mobile GPUs, and check budgets",
         .examples = {"glint lint scene.glint", "glint lint scene.glint --max-texture-fetches 12 --werror"},
         .usual = {"--max-instructions", "--max-texture-fetches", "--max-ray-queries", "--malioc", "--core",
                   "--werror", "-W", "--json"}});
    addTexts(command, "PATH", arguments->paths, "FILE|DIR",
             "SPIR-V files, packages, or folders of .spv files")
        .required();
    addBudget(command, "--max-instructions", arguments->instructions, "instructions");
    addBudget(command, "--max-texture-fetches", arguments->textureFetches, "texture fetches");
    addBudget(command, "--max-ray-queries", arguments->rayQueries, "ray queries");
    addText(command, "--malioc", arguments->malioc, "PROGRAM",
            "Arm's Mali Offline Compiler; for cycles and registers of compute shaders (default: malioc, if "
            "PATH has it)");
    addText(command, "--core", arguments->core, "NAME",
            "the GPU that malioc compiles for (default: malioc's)");
    command.callback([arguments, &chosen] {
        chosen = [arguments](const Console& console) { return lint(console, *arguments); };
    });
}

}  // namespace glint::cli
