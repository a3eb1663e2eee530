// --strategy auto of `glint compile`: decides which strategies a package gets.
#pragma once

#include "cli/compile_arguments.h"
#include "gltf/scene_list.h"

#include <glint/result.h>

namespace glint {

// Replaces "auto" among the strategies by the one that should be fastest for a frame of 1920 x 1080 of each
// scene, taken together. It uses the device of the calibration, or else the built-in GPU. If the choice is
// hit-shaders, which not every device runs, uber is added. Has the errors of knownCosts() and
// adviseStrategy().
Status settleStrategies(const SceneList& scenes, const PlanOptions& plan, CompileArguments& arguments);

}  // namespace glint
