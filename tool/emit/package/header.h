// glint_tables.h: shader IDs, features and layouts for C++.
#pragma once

#include "emit/source_set.h"
#include "gltf/scene_list.h"
#include "plan/plan.h"

#include <glint/result.h>

#include <string>

namespace glint::compiler {

// Returns the header's text. Has the errors of renderTemplate() and flatten().
Result<std::string> makeHeader(const gltf::SceneList& scenes, const Plan& plan, const SourceSet& sources,
                               const PlanOptions& options);

// Returns the namespace within glint: "scene_" and the file's name, as an identifier.
std::string headerNamespace(const std::string& scenePath);

}  // namespace glint::compiler
