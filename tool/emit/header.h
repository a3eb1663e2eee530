// glint_tables.h: shader IDs, features and layouts for C++.
#pragma once

#include "emit/compile.h"
#include "emit/sources.h"
#include "gltf/scene_list.h"

#include <string>

namespace glint {

// Errors of renderTemplate() and flatten().
Result<std::string> makeHeader(const SceneList& scenes, const Plan& plan, const SourceSet& sources,
                               const PlanOptions& options);

// "scene_" and the file's name, as an identifier: the namespace within glint.
std::string headerNamespace(const std::string& scenePath);

}  // namespace glint
