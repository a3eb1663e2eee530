// Findings about a SPIR-V module: ray queries that fall off the fast path of mobile compilers, and ray
// tracing shaders that cost more than they need to. docs/lint.md describes each rule.
#pragma once

#include "spirv/statistics.h"

#include <glint/result.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint {

// Where an instruction stands in the module as it was given, whatever was inlined since.
struct SpirvPlace {
    std::string function;    // its name, else the entry point's, else "%id"; empty outside of functions
    std::string source;      // "shader.comp:12", from OpLine; empty where the module has none
    std::uint32_t id = 0;    // of its result; 0: it has none
    std::size_t offset = 0;  // of its first word from the start of the module; 0: the module as a whole
};

struct LintFinding {
    Severity severity = Severity::Warning;
    std::string rule;  // stable, for instance "query-proceeds"
    SpirvPlace place;
    std::string message;  // one sentence, no final full stop
    std::string hint;     // what to do
};

struct SpirvLint {
    SpirvStatistics statistics;
    std::vector<std::string> stages;    // execution models of the entry points, "GLCompute", "ClosestHitKHR"
    std::vector<LintFinding> findings;  // in the order of the module
};

// Inlines and folds a copy of the module, as a driver would, and judges that. Errors: "spirv-format" where
// `words` is no SPIR-V module, "spirv-invalid" with what the validator says.
Result<SpirvLint> lintSpirv(std::span<const std::uint32_t> words);

// "in main (shader.comp:12, word 214)"; empty for the module as a whole.
std::string toString(const SpirvPlace& place);

}  // namespace glint
