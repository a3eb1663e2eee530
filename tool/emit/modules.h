// Decides which shader modules a package has, and makes their GLSL.
#pragma once

#include "emit/source_set.h"
#include "emit/warm_modules.h"
#include "gltf/scene_list.h"
#include "plan/plan.h"
#include "settings/settings.h"

#include <glint/result.h>

#include <vector>

namespace glint::compiler {

// Returns the modules that the settings call for, in order of their keys. `warm` may be null. Has the errors
// of renderTemplate() and flatten().
Result<std::vector<ModuleSource>> makeModuleSources(const gltf::SceneList& scenes, const Plan& plan,
                                                    const SourceSet& sources, const CompileSettings& settings,
                                                    WarmModules* warm = nullptr);

// Returns the module of an early package that shows `edited` features. Has the errors of makeModuleSources().
Result<ModuleSource> makeEditSource(const gltf::SceneList& scenes, const Plan& plan, const SourceSet& sources,
                                    const CompileSettings& settings, materials::FeatureMask edited,
                                    WarmModules* warm = nullptr);

}  // namespace glint::compiler
