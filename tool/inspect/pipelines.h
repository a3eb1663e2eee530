// A driver's statistics of the pipelines of a package: reports, their differences, and budgets.
//
// Drivers name their statistics as they like, and count other things. A report keeps each statistic under its
// driver's name, and adds facts that mean the same on every device.
#pragma once

#include "base/fields_fwd.h"
#include "base/files.h"
#include "inspect/package.h"
#include "plan/gpu_costs.h"

#include <glint/context.h>
#include <glint/internal/package_pipelines.h>
#include <glint/package.h>
#include <glint/result.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint {

base::Fields fieldsOf(const Renderer::PipelineStatistics*);

}  // namespace glint

namespace glint::compiler {

base::Fields fieldsOf(const GpuCosts*);

}  // namespace glint::compiler

namespace glint::inspect {

// A fact is absent if the driver does not report the statistics from which it follows.
struct PipelineFacts {
    std::optional<double> registers;     // 32-bit registers that a lane holds at once, uniform ones left out
    std::optional<double> spills;        // of registers: to memory, or from uniform registers to others
    std::optional<double> scratchBytes;  // memory of a lane for spills, arrays and stacks
    std::optional<double> codeBytes;     // machine code
    std::optional<double> occupancy;  // share of the subgroups (on Intel: of the lanes) that fit, at most 1
    // Estimated cycles that a processor of the GPU is busy for 64 lanes, by the compiler's own model. Where
    // the compiler tells latency from throughput, the subgroups in flight hide the former. Numbers of two
    // drivers can't be compared.
    std::optional<double> cost;
};

struct FactInfo {
    std::string_view name;    // in JSON, budgets and options
    std::string_view column;  // in tables
    std::optional<double> PipelineFacts::*member;
    bool isLeast;  // A budget is the least value that is allowed, not the most.
};
std::span<const FactInfo> factTable();

// Returns the facts about one executable.
PipelineFacts factsOf(const Renderer::PipelineStatistics::Executable& executable);
// Returns the facts of all executables of a pipeline: the most registers, scratch memory and cost, the least
// occupancy, and the sum of spills and code.
PipelineFacts factsOf(std::span<const Renderer::PipelineStatistics::Executable> executables);

// A module that a pipeline was made for.
struct ReportedModule {
    std::string role;
    std::optional<std::uint32_t> shaderId;  // of modules of cases
    std::string file;
    double share = 0.0;  // of the hits that the compiler expects, of cases
    // Counts of its SPIR-V; a fetch counts as one instruction.
    double instructions = 0.0;
    double textureFetches = 0.0;
};

struct ReportedPipeline {
    std::string name;    // role of its module, and the name of its case, effect or ordering
    std::string tracer;  // empty: it traces nothing, or it has no other tracer
    std::vector<std::string> strategies;
    std::vector<ReportedModule> modules;
    std::uint32_t subgroupSize = 0;  // 0: the driver does not say
    std::optional<double> creationMs;
    std::string failure;  // why the driver did not make it; empty: it did
    PipelineFacts facts;
    std::vector<Renderer::PipelineStatistics::Executable> executables;  // not read from files
};

struct PipelineReport {
    std::string package;  // as given on the command line
    std::string merge;    // of its manifest
    std::string shadows;  // "inline" or "deferred"
    std::uint32_t precision = 32;
    std::string device;
    std::string driver;
    std::string deviceType;          // "cpu" or "gpu"
    std::uint32_t subgroupSize = 0;  // the device's usual one
    bool hasStatistics = true;       // the device reports statistics
    std::vector<ReportedPipeline> pipelines;
};

// Requests everything that the package needs of a device.
void requirePackage(const Package& package, HeadlessOptions& options);

// Makes every pipeline of the package, which reports call `name`. Has the errors of makePackagePipelines()
// and inspectPackage().
Result<PipelineReport> reportPipelines(Context& context, const Package& package, const Manifest& manifest,
                                       const std::string& name, std::uint32_t threads = 0);

// Returns the modules by role and tracer, for cost models and readers in a hurry.
compiler::PackageCosts summarize(const PipelineReport& report);

// Joins reports of one device into the table of a GPU. Requires at least one report.
compiler::GpuCosts gpuOf(std::string name, std::span<const PipelineReport> reports);
// Returns the names of the GPUs whose tables are built in.
std::vector<std::string> builtInGpus();
// Reads the table of a GPU: one that is built in, or a file. Errors: those of readFile(), "gpu-unknown",
// "gpu-table".
Result<compiler::GpuCosts> readGpuCosts(const std::string& nameOrFile);

// Sorts by a fact, the worst first, or by name if it is null. Pipelines without the fact come last.
void sortPipelines(PipelineReport& report, const FactInfo* fact);

base::Fields fieldsOf(const PipelineReport*);
std::string textOf(const Renderer::PipelineStatistics::Statistic& statistic);

// Reads the JSON of a report. Errors: those of readFile(), "pipeline-report" (not such a file).
Result<PipelineReport> readPipelineReport(const std::filesystem::path& file);

// Returns the pipeline of another report that corresponds to this one: that of the same name and tracer, or
// the only one of that name. Null if there is none.
const ReportedPipeline* findCounterpart(const PipelineReport& report, const ReportedPipeline& pipeline);

// Limits of facts. The first rule whose pattern fits the name of a pipeline and that has a limit for a fact
// decides about that fact.
struct PipelineBudget {
    struct Rule {
        std::string pipelines;  // pattern: '*' stands for any text
        std::string device;     // part of the device's name; empty: every device
        PipelineFacts limits;
    };
    std::string file;
    std::vector<Rule> rules;
};
// Errors: those of readFile(), "pipeline-budget-file".
Result<PipelineBudget> readPipelineBudget(const std::filesystem::path& file);

// Returns an error "pipeline-budget" for each fact that exceeds its limit or that the driver does not report,
// and a warning "pipeline-budget-unused" for each rule that fits no pipeline of its device.
std::vector<Diagnostic> overBudget(const PipelineReport& report, const PipelineBudget& budget);

using base::BuiltinFile;

std::span<const BuiltinFile> gpuTables();

}  // namespace glint::inspect
