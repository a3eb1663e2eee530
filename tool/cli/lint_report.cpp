#include "cli/lint_report.h"

#include "cli/report.h"
#include "cli/table.h"

#include <fmt/format.h>

#include <algorithm>

namespace glint {

namespace {

std::size_t countIn(const std::vector<LintFinding>& findings, Severity severity) {
    return static_cast<std::size_t>(std::ranges::count(findings, severity, &LintFinding::severity));
}

Json findingsToJson(const std::vector<LintFinding>& findings, const std::string& where) {
    Json list = Json::array();
    for (const LintFinding& finding : findings) {
        Diagnostic diagnostic = toDiagnostic(finding, where);
        diagnostic.message = finding.message;
        Json json = toJson(diagnostic);
        json["function"] = textOrNull(finding.place.function);
        json["source"] = textOrNull(finding.place.source);
        json["resultId"] = finding.place.id == 0 ? Json(nullptr) : Json(finding.place.id);
        json["word"] = finding.place.offset == 0 ? Json(nullptr) : Json(finding.place.offset);
        list.push_back(std::move(json));
    }
    return list;
}

Json toJson(const MaliocReport& report) {
    return {{"core", textOrNull(report.core)},
            {"longestCycles", orNull(report.longestCycles)},
            {"boundPipelines", report.boundPipelines},
            {"cycles", report.cycles},
            {"workRegisters", orNull(report.workRegisters)},
            {"occupancy", orNull(report.occupancy)},
            {"spills", orNull(report.spills)},
            {"spillBytes", orNull(report.spillBytes)}};
}

Json toJson(const SpirvStatistics& statistics) {
    return {{"bytes", statistics.bytes},
            {"instructions", statistics.instructions},
            {"textureFetches", statistics.textureFetches},
            {"rayQueries", statistics.rayQueries},
            {"traces", statistics.traces},
            {"functions", statistics.functions},
            {"branches", statistics.branches}};
}

Json toJson(const LintedModule& module) {
    return {{"file", module.file.path.string()},
            {"name", textOrNull(module.file.name)},
            {"stages", module.lint ? Json(module.lint->stages) : Json::array()},
            {"statistics", module.lint ? toJson(module.lint->statistics) : Json(nullptr)},
            {"malioc", module.malioc ? toJson(*module.malioc) : Json(nullptr)},
            {"findings", findingsToJson(module.findings, module.file.path.string())}};
}

std::vector<std::string> countsOf(const LintedModule& module) {
    if (!module.lint) {
        return {"-", "-", "-", "-", "-", "-"};
    }
    const SpirvStatistics& it = module.lint->statistics;
    return {join(module.lint->stages),
            fmt::format("{}", it.instructions),
            fmt::format("{}", it.textureFetches),
            fmt::format("{}", it.rayQueries),
            fmt::format("{}", it.traces),
            fmt::format("{}", it.functions)};
}

std::vector<std::string> cyclesOf(const LintedModule& module) {
    if (!module.malioc) {
        return {"-", "-", "-", "-"};
    }
    const MaliocReport& it = *module.malioc;
    const std::string spills = it.spillBytes ? fmt::format("{}", *it.spillBytes)
                               : it.spills   ? (*it.spills ? "yes" : "no")
                                             : "-";
    return {it.longestCycles ? fmt::format("{:.2f}", *it.longestCycles) : "-", join(it.boundPipelines),
            it.workRegisters ? fmt::format("{}", *it.workRegisters) : "-", spills};
}

// Returns "-" for 0, so that other numbers stand out.
std::string nonZero(std::size_t count) {
    return count == 0 ? "-" : fmt::format("{}", count);
}

std::string plural(std::size_t count, const char* noun) {
    return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::string summaryOf(const LintReport& report) {
    return fmt::format("\n{}: {}, {}, {}\n", plural(report.modules.size(), "module"),
                       plural(report.count(Severity::Error), "error"),
                       plural(report.count(Severity::Warning), "warning"),
                       plural(report.count(Severity::Note), "note")) +
           (report.malioc ? "" : "malioc not found: no cycle estimates\n");
}

}  // namespace

std::size_t LintReport::count(Severity severity) const {
    std::size_t total = 0;
    for (const LintedModule& module : modules) {
        total += countIn(module.findings, severity);
    }
    for (const LintedFolder& folder : folders) {
        total += countIn(folder.findings, severity);
    }
    return total;
}

Diagnostic toDiagnostic(const LintFinding& finding, const std::string& where) {
    const std::string place = toString(finding.place);
    return {finding.severity, finding.rule, where, (place.empty() ? "" : place + ": ") + finding.message,
            finding.hint};
}

std::string toText(const LintReport& report, Detail detail) {
    const auto isNamed = [](const LintedModule& module) { return !module.file.name.empty(); };
    const auto isEstimated = [](const LintedModule& module) { return module.malioc.has_value(); };
    // Files are named after their shaders, so the short table has their names alone.
    const bool hasNames = detail == Detail::Whole && std::ranges::any_of(report.modules, isNamed);
    const bool hasCycles = std::ranges::any_of(report.modules, isEstimated);
    std::vector<std::vector<std::string>> rows{
        {"file", "instructions", "fetches", "queries", "traces", "errors", "warnings"}};
    if (detail == Detail::Whole) {
        rows[0] = {"file",   "stage",     "instructions", "fetches", "queries",
                   "traces", "functions", "errors",       "warnings"};
    }
    if (hasNames) {
        rows[0].insert(rows[0].begin(), "module");
    }
    if (hasCycles) {
        rows[0].insert(rows[0].end(), {"cycles", "bound by", "registers", "spilled"});
    }
    for (const LintedModule& module : report.modules) {
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
        row.push_back(nonZero(countIn(module.findings, Severity::Error)));
        row.push_back(nonZero(countIn(module.findings, Severity::Warning)));
        if (hasCycles) {
            std::ranges::move(cyclesOf(module), std::back_inserter(row));
        }
        rows.push_back(std::move(row));
    }
    return formatTable(rows, detail) + summaryOf(report);
}

Json toJson(const LintReport& report) {
    Json modules = Json::array();
    for (const LintedModule& module : report.modules) {
        modules.push_back(toJson(module));
    }
    Json findings = Json::array();
    for (const LintedFolder& folder : report.folders) {
        for (Json& finding : findingsToJson(folder.findings, folder.path)) {
            findings.push_back(std::move(finding));
        }
    }
    return {{"modules", std::move(modules)},
            {"findings", std::move(findings)},
            {"errors", report.count(Severity::Error)},
            {"warnings", report.count(Severity::Warning)},
            {"notes", report.count(Severity::Note)},
            {"malioc", report.malioc ? Json(report.malioc->string()) : Json(nullptr)}};
}

}  // namespace glint
