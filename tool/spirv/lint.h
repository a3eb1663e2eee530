// Finds ray queries in a SPIR-V module that leave the fast path of mobile compilers, and ray tracing shaders
// that cost more than they need to. docs/lint.md describes each rule.
#pragma once

#include "spirv/lint_finding.h"
#include "spirv/statistics.h"

#include <glint/result.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace glint::compiler {

struct SpirvLint {
    SpirvStatistics statistics;
    std::vector<std::string> stages;    // execution models of the entry points, "GLCompute", "ClosestHitKHR"
    std::vector<LintFinding> findings;  // in the order of the module
};

// Inlines and folds a copy of the module, as a driver would, and applies the rules to it. Errors:
// "spirv-format" if `words` is no SPIR-V module, "spirv-invalid" with the validator's message.
Result<SpirvLint> lintSpirv(std::span<const std::uint32_t> words);

}  // namespace glint::compiler
