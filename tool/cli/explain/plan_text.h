// glint explain --plan: shows the cases of a plan, the cost of each by the cost model, and why there are no
// fewer.
#pragma once

#include "cli/report.h"
#include "cli/table.h"
#include "resolve/build.h"

#include <string>

namespace glint::cli {

std::string planText(const compiler::Build& build, Detail detail);

// Returns the members that `explain --plan --json` adds to the plan's options: docs/cli.md lists them.
base::Json planToJson(const compiler::Build& build);

// Returns a table of milliseconds, the recommended strategy and the reason.
std::string strategiesText(const compiler::StrategyAdvice& advice);

}  // namespace glint::cli
