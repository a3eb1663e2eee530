// The text of glint explain about a material: its keys and cases, and why.
#pragma once

#include "cli/explain/plan_text.h"

#include <string>
#include <vector>

namespace glint::cli {

// Returns rows of a label and a text. There are none if no primitive has the material.
std::vector<std::vector<std::string>> materialRows(const compiler::Build& build, int material, Detail detail);
// Returns a member of `materials` of `explain --json`: docs/cli.md lists its members.
base::Json materialToJson(const compiler::Build& build, int material);

}  // namespace glint::cli
