// glint_tables.h: shader IDs, features and layouts for C++.
#pragma once

#include "emit/compile.h"
#include "emit/sources.h"
#include "gltf/scene_list.h"

#include <string>

namespace glint::compiler {

// Returns the header's text. Has the errors of renderTemplate() and flatten().
Result<std::string> makeHeader(const gltf::SceneList& scenes, const Plan& plan, const SourceSet& sources,
                               const PlanOptions& options);

// Returns the namespace within glint: "scene_" and the file's name, as an identifier.
std::string headerNamespace(const std::string& scenePath);

}  // namespace glint::compiler
