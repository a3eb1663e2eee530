// --strategy auto of `glint compile`: which strategies a package gets.
#pragma once

#include "cli/compile_arguments.h"
#include "gltf/scene_list.h"

#include <glint/result.h>

namespace glint {

// Replaces "auto" among the strategies by the one that should be fastest for a frame of 1920 x 1080 of each
// scene, all together, with the device of the calibration, else the GPU that is built in; and by uber beside
// it where that is hit-shaders, which not every device runs. Errors of knownCosts() and adviseStrategy().
Status settleStrategies(const SceneList& scenes, const PlanOptions& plan, CompileArguments& arguments);

}  // namespace glint
