// The rules about ray queries.
#pragma once

#include "spirv/lint.h"

#include <map>

namespace glint {

// Appends the findings about a valid module; `places` as findPlaces() gives them for it.
void lintQueries(std::span<const std::uint32_t> words, const std::map<std::size_t, SpirvPlace>& places,
                 std::vector<LintFinding>& findings);

}  // namespace glint
