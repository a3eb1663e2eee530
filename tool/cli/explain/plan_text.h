// glint explain --plan: shows the cases of a plan, the cost of each by the cost model, and why there are no
// fewer.
#pragma once

#include "cli/report.h"
#include "cli/table.h"
#include "gltf/scene_list.h"
#include "plan/plan.h"
#include "plan/strategy_choice.h"

#include <string>

namespace glint::cli {

struct PlannedScenes {
    const gltf::SceneList& scenes;
    const compiler::PlanOptions& options;
    const compiler::Plan& plan;
};

std::string planText(const PlannedScenes& planned, Detail detail);

// Returns the members that `explain --plan --json` adds to the plan's options: docs/cli.md lists them.
base::Json planToJson(const PlannedScenes& planned);

// Returns a table of milliseconds, the recommended strategy and the reason.
std::string strategiesText(const compiler::StrategyAdvice& advice);

}  // namespace glint::cli
