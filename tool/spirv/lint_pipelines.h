// The lint rules about shaders of ray tracing pipelines.
#pragma once

#include "spirv/lint.h"

#include <map>

namespace glint::compiler {

// Appends the findings about a valid module. `places` comes from findPlaces() for the same module.
void lintPipelines(std::span<const std::uint32_t> words, const std::map<std::size_t, SpirvPlace>& places,
                   std::vector<LintFinding>& findings);

}  // namespace glint::compiler
