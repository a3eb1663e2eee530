#include "cli/inspect/pipelines.h"

#include "cli/command_line.h"
#include "cli/render/report.h"
#include "cli/table.h"

#include <glint/measure/observer.h>

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace glint::cli {

namespace {

using inspect::FactInfo;
using inspect::ReportedPipeline;

constexpr const char* kSortByName = "name";

std::vector<std::string> sortWords() {
    std::vector<std::string> words{kSortByName};
    for (const FactInfo& info : inspect::factTable()) {
        words.emplace_back(info.name);
    }
    return words;
}

// Returns null for the name.
const FactInfo* factNamed(const std::string& name) {
    const auto found = std::ranges::find(inspect::factTable(), name, &FactInfo::name);
    return found == inspect::factTable().end() ? nullptr : &*found;
}

// Returns one value if both are the same, "before → after" otherwise.
std::string cellOf(const FactInfo& info, const ReportedPipeline& pipeline, const ReportedPipeline* before) {
    const std::string text = factText(info, pipeline.facts);
    const std::string other = before == nullptr ? text : factText(info, before->facts);
    return text == other ? text : other + " → " + text;
}

std::string subgroupText(std::uint32_t size) {
    return size > 0 ? std::to_string(size) : "-";
}

std::vector<std::string> rowOf(const ReportedPipeline& pipeline, const ReportedPipeline* before,
                               bool traces) {
    std::vector<std::string> row{pipeline.name};
    if (traces) {
        row.push_back(pipeline.tracer.empty() ? "-" : pipeline.tracer);
    }
    row.push_back(subgroupText(pipeline.subgroupSize));
    if (!pipeline.failure.empty()) {
        row.push_back("failed");
        return row;
    }
    for (const FactInfo& info : inspect::factTable()) {
        row.push_back(cellOf(info, pipeline, before));
    }
    return row;
}

// Whether pipelines differ in their tracer.
bool haveTracers(const inspect::PipelineReport& report) {
    std::set<std::string> tracers;
    for (const ReportedPipeline& pipeline : report.pipelines) {
        tracers.insert(pipeline.tracer);
    }
    tracers.erase("");
    return tracers.size() > 1;
}

std::string describe(const inspect::PipelineReport& report) {
    return fmt::format("{} on {} ({})", report.package, report.device, report.driver);
}

std::string toText(const inspect::PipelineReport& report, const inspect::PipelineReport* other,
                   const std::string& sort, Detail detail) {
    Rows fields{{"package", report.package},
                {"device",
                 fmt::format("{} ({}), subgroups of {}", report.device, report.driver, report.subgroupSize)},
                {"pipelines", fmt::format("{}, by {}", report.pipelines.size(), sort)}};
    if (other != nullptr) {
        fields.push_back({"before →", describe(*other)});
    }
    std::string text = formatFields(fields) + "\n" + pipelineTable(report, other, detail);
    if (other != nullptr) {
        std::vector<std::string> gone;
        for (const ReportedPipeline& pipeline : other->pipelines) {
            if (inspect::findCounterpart(report, pipeline) == nullptr) {
                gone.push_back(pipeline.name);
            }
        }
        text += gone.empty() ? "" : "\n" + formatFields({{"only before", base::join(gone)}}, detail);
    }
    return text;
}

Result<inspect::PipelineReport> make(const Console& console, const Package& package,
                                     const std::string& folder, const PackagePipelineArguments& arguments) {
    console.progress("making the pipelines of " + folder);
    GLINT_TRY(const auto manifest, inspect::readManifest(folder));
    HeadlessOptions options;
    options.deviceName = arguments.device;
    options.validation = arguments.validate ? Validation::On : Validation::Off;
    options.pipelineStatistics = true;
    inspect::requirePackage(package, options);
    GLINT_TRY(auto context, Context::createHeadless(options));
    Result<inspect::PipelineReport> report = inspect::reportPipelines(
        *context, package, manifest, folder, static_cast<std::uint32_t>(arguments.threads));
    if (Status valid = measure::checkValidation(console, *context); report && !valid) {
        return valid.error();
    }
    return report;
}

// Makes or reads the report to compare with.
Result<inspect::PipelineReport> obtainOther(const Console& console,
                                            const PackagePipelineArguments& arguments) {
    if (!std::filesystem::is_directory(arguments.compare)) {
        return inspect::readPipelineReport(arguments.compare);
    }
    GLINT_TRY(const auto package, Package::load(arguments.compare));
    return make(console, package, arguments.compare, arguments);
}

// Reports pipelines that could not be made, statistics that are missing, and budgets that are exceeded.
// Returns whether all is well.
bool judge(const Console& console, const inspect::PipelineReport& report,
           const std::optional<inspect::PipelineBudget>& budget) {
    bool good = true;
    const auto tell = [&](const Diagnostic& diagnostic) {
        console.report(diagnostic);
        good = good && diagnostic.severity != Severity::Error;
    };
    for (const ReportedPipeline& pipeline : report.pipelines) {
        if (!pipeline.failure.empty()) {
            tell(makeError(
                "pipeline-failed", report.package,
                fmt::format("{} could not be made on {}: {}", pipeline.name, report.device, pipeline.failure),
                "update the driver, or report the module to its makers"));
        }
    }
    if (!report.hasStatistics) {
        tell(Diagnostic{Severity::Note, "pipeline-statistics", report.device,
                        "has no VK_KHR_pipeline_executable_properties: there are no statistics",
                        "use another device"});
    }
    if (budget) {
        std::ranges::for_each(overBudget(report, *budget), tell);
    }
    return good;
}

}  // namespace

std::string pipelineTable(const inspect::PipelineReport& report, const inspect::PipelineReport* other,
                          Detail detail) {
    const bool traces = haveTracers(report);
    Rows rows{{"pipeline"}};
    if (traces) {
        rows.front().emplace_back("tracer");
    }
    rows.front().emplace_back("subgroup");
    for (const FactInfo& info : inspect::factTable()) {
        rows.front().emplace_back(info.column);
    }
    for (const ReportedPipeline& pipeline : report.pipelines) {
        rows.push_back(
            rowOf(pipeline, other == nullptr ? nullptr : findCounterpart(*other, pipeline), traces));
    }
    return formatTable(rows, detail);
}

void addPipelineReportOptions(CLI::App& command, PackagePipelineArguments& arguments) {
    const OptionGroup group(command, "Pipelines");
    CLI::Option* const pipelines =
        &addFlag(command, "--pipelines", arguments.enabled,
                 "make every pipeline of the package on the device, and show what its driver says of them");
    const auto ofPipelines = [&](CLI::Option& option) { option.needs(pipelines); };
    addDeviceChoice(command, arguments.device, arguments.validate);
    ofPipelines(*command.get_option("--device"));
    ofPipelines(*command.get_option("--validate"));
    ofPipelines(addChoice(command, "--sort", arguments.sort, sortWords(), "what the list is sorted by"));
    ofPipelines(
        addText(command, "--compare", arguments.compare, "FILE|DIR",
                "show what was before beside it: a report of --json, or another package (default: nothing)"));
    ofPipelines(addText(command, "--budget", arguments.budget, "FILE",
                        "report an error where a pipeline exceeds a limit of the file (default: no limits)"));
    ofPipelines(addInteger(command, "--pipeline-threads", arguments.threads, 0, 1024,
                           "threads that make pipelines; 0: as many as the machine runs at once"));
}

Result<int> showPipelines(const Console& console, const Package& package, const std::string& folder,
                          const PackagePipelineArguments& arguments) {
    std::optional<inspect::PipelineBudget> budget;
    if (!arguments.budget.empty()) {
        GLINT_TRY(budget, inspect::readPipelineBudget(arguments.budget));
    }
    std::optional<inspect::PipelineReport> other;
    if (!arguments.compare.empty()) {
        GLINT_TRY(other, obtainOther(console, arguments));
    }
    GLINT_TRY(auto report, make(console, package, folder, arguments));
    sortPipelines(report, factNamed(arguments.sort));
    const bool good = judge(console, report, budget);
    if (console.isJson()) {
        base::Json json = base::jsonOf(report);
        json["compared"] = other ? base::jsonOf(*other) : base::Json(nullptr);
        for (base::Json& pipeline : other ? json["compared"]["pipelines"] : json["compared"]) {
            pipeline.erase("executables");
        }
        console.result(json);
    } else {
        console.print(toText(report, other ? &*other : nullptr, arguments.sort,
                             console.isVerbose() ? Detail::Whole : Detail::Short));
    }
    return good ? kExitDone : kExitFailed;
}

}  // namespace glint::cli
