// The values of a compilation that templates can use.
#pragma once

#include "emit/source_set.h"
#include "gltf/scene_list.h"
#include "plan/plan.h"

#include <glint/result.h>

#include <kainjow/mustache.hpp>

#include <string>
#include <string_view>

namespace glint::compiler {

// Returns the tool's version, "0.1.0".
std::string_view toolVersion();

// Turns `text` into one line of printable ASCII that neither ends a comment nor continues its line. Long
// names are cut.
std::string commentText(std::string_view text);

// Makes the context: version, source, merge, alpha, and `cases`, a list of the fields that addCase() adds.
// Retired cases are left out.
kainjow::mustache::data makeContext(const gltf::SceneList& scenes, const Plan& plan,
                                    const PlanOptions& options);

// Adds the fields of one case to the top level: id, name, alwaysLobes, alwaysInputs, sometimesLobes,
// sometimesInputs, always, sometimes, materials.
void addCase(kainjow::mustache::data& context, const gltf::SceneList& scenes,
             const materials::MaterialModel& model, const Case& shaderCase);

// Renders the template `name` without HTML escapes. Error "template" if it is missing or malformed.
Result<std::string> renderTemplate(const SourceSet& sources, std::string_view name,
                                   const kainjow::mustache::data& context);

}  // namespace glint::compiler
