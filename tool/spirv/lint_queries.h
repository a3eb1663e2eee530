// The lint rules about ray queries.
#pragma once

#include "spirv/lint.h"

#include <map>

namespace glint::compiler {

// Appends the findings about a valid module. `places` comes from findPlaces() for the same module.
void lintQueries(std::span<const std::uint32_t> words, const std::map<std::size_t, SpirvPlace>& places,
                 std::vector<LintFinding>& findings);

}  // namespace glint::compiler
