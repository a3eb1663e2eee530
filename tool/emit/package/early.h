// Early packages: the package before an edit of a pack's GLSL, with one more module that shows the edit as a
// draft (docs/live.md). It takes a small part of the time of the whole package.
#pragma once

#include "emit/package/compiled_package.h"
#include "emit/source_set.h"
#include "gltf/scene_list.h"
#include "settings/compile_settings.h"

#include <optional>

namespace glint::compiler {

class WarmModules;

// Returns the features that an early package can show the edit from `before` to `after` of: those of packs
// with GLSL that differs, at stages that a draft has (coordinates, surface, emission). Returns 0 if other
// GLSL differs, too. Declarations must not differ.
materials::FeatureMask editedFeatures(const materials::MaterialModel& before,
                                      const materials::MaterialModel& after);

// Makes the early package that shows how `plan` and `sources` differ from `before`, which is a whole package.
// Returns no value if no early package can show it: the package draws no frame, its tables differ, or
// editedFeatures() are none that a primitive has. Has the errors of makeEditSource() and compileModules().
Result<std::optional<CompiledPackage>> makeEarlyPackage(const gltf::SceneList& scenes, const Plan& plan,
                                                        const SourceSet& sources,
                                                        const CompileSettings& settings,
                                                        const CompiledPackage& before, WarmModules* warm);

}  // namespace glint::compiler
