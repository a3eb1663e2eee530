// Makes the options of planning from the command line and files.
#pragma once

#include "cli/options.h"
#include "cli/profile.h"
#include "gltf/scene_list.h"

#include <glint/result.h>

#include <vector>

namespace glint {

struct PlanChoice {
    PlanOptions options;
    std::vector<Diagnostic> warnings;
    std::vector<Diagnostic> notes;
};

// Returns the options of the command line, with the hits of its profile if it names one, and with the alpha
// policy that `auto` stands for. Notes say what was chosen. Warns of keys that
// the scene has and the profile lacks, and of a profile that was made with other settings. Has the errors of
// readProfile().
Result<PlanChoice> choosePlan(const PlanArguments& arguments, const SceneList& scenes);

}  // namespace glint
