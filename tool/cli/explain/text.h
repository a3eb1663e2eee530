// The texts of glint explain: cases and their costs, strategies, materials with their keys.
#pragma once

#include "cli/report.h"
#include "cli/table.h"
#include "resolve/build.h"

#include <string>
#include <vector>

namespace glint::cli {

std::string planText(const compiler::Build& build, Detail detail);

// Returns the members that `explain --plan --json` adds to the plan's options: docs/cli.md lists them.
base::Json planToJson(const compiler::Build& build);

// Returns a table of milliseconds, the recommended strategy and the reason.
std::string strategiesText(const compiler::StrategyAdvice& advice);

// --- The text of glint explain about a material: its keys and cases, and why ---

// Returns rows of a label and a text. There are none if no primitive has the material.
std::vector<std::vector<std::string>> materialRows(const compiler::Build& build, int material, Detail detail);
// Returns a member of `materials` of `explain --json`: docs/cli.md lists its members.
base::Json materialToJson(const compiler::Build& build, int material);

}  // namespace glint::cli
