// The lint rules about ray queries and about shaders of ray tracing pipelines.
#pragma once

#include "spirv/lint_finding.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace glint::compiler {

// Both append the findings about a valid module. `places` comes from findPlaces() for the same module.
void lintQueries(std::span<const std::uint32_t> words, const std::map<std::size_t, SpirvPlace>& places,
                 std::vector<LintFinding>& findings);
void lintPipelines(std::span<const std::uint32_t> words, const std::map<std::size_t, SpirvPlace>& places,
                   std::vector<LintFinding>& findings);

}  // namespace glint::compiler
