// glint inspect --pipelines: what the device's compiler makes of a package.
#pragma once

#include "cli/console.h"
#include "cli/options/options.h"
#include "cli/table.h"
#include "inspect/pipelines.h"

#include <glint/package.h>

#include <cstdint>
#include <string>

namespace glint::cli {

struct PackagePipelineArguments {
    bool enabled = false;
    std::string device;         // part of its name; empty: the first suitable one
    std::string sort = "cost";  // name of a fact, or "name"
    std::string compare;        // a report or a package; empty: nothing
    std::string budget;         // a file; empty: none
    std::int64_t threads = 0;
    bool validate = false;
};

void addPipelineReportOptions(CLI::App& command, PackagePipelineArguments& arguments);

// Makes the pipelines of the package in `folder` and prints the report. Returns the exit code.
Result<int> showPipelines(const Console& console, const Package& package, const std::string& folder,
                          const PackagePipelineArguments& arguments);

// Returns the table, with the facts of `other` beside those of `report` unless it is null.
std::string pipelineTable(const inspect::PipelineReport& report, const inspect::PipelineReport* other,
                          Detail detail);

}  // namespace glint::cli
