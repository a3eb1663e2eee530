// What templates know of a compilation.
#pragma once

#include "emit/compile.h"
#include "emit/sources.h"

#include <kainjow/mustache.hpp>

#include <string>
#include <string_view>

namespace glint {

// The tool's version, "0.1.0".
std::string_view toolVersion();

// One line of printable ASCII that neither ends a comment nor continues its line; long names are cut.
std::string commentText(std::string_view text);

// version, source, merge, alpha, and `cases`: a list of what addCase() adds, retired ones left out.
kainjow::mustache::data makeContext(const SceneList& scenes, const Plan& plan, const PlanOptions& options);

// Adds the fields of one case to the top level: id, name, alwaysLobes, alwaysInputs, sometimesLobes,
// sometimesInputs, always, sometimes, materials.
void addCase(kainjow::mustache::data& context, const SceneList& scenes, const Case& shaderCase);

// Renders the template `name` without HTML escapes. Error "template": missing, or malformed.
Result<std::string> renderTemplate(const SourceSet& sources, std::string_view name,
                                   const kainjow::mustache::data& context);

}  // namespace glint
