// glint explain --plan: the cases of a plan, what each costs by the cost model, and why there are no fewer.
#pragma once

#include "cli/report.h"
#include "cli/table.h"
#include "gltf/scene_list.h"
#include "plan/plan.h"

#include <string>

namespace glint {

struct PlannedScenes {
    const SceneList& scenes;
    const PlanOptions& options;
    const Plan& plan;
};

std::string planText(const PlannedScenes& planned, Detail detail);

// What `explain --plan --json` has beside the plan's options: docs/cli.md has the members.
Json planToJson(const PlannedScenes& planned);

}  // namespace glint
