// Finds ray queries in a SPIR-V module that leave the fast path of mobile compilers, and ray tracing shaders
// that cost more than they need to. docs/lint.md describes each rule.
#pragma once

#include "spirv/statistics.h"

#include <glint/result.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace glint::compiler {

// The place of an instruction in the original module, before any inlining.
struct SpirvPlace {
    std::string function;    // the function's name, else the entry point's, else "%id"; empty outside of
                             // functions
    std::string source;      // "shader.comp:12", from OpLine; empty if the module has none
    std::uint32_t id = 0;    // ID of its result; 0 if it has none
    std::size_t offset = 0;  // index of its first word in the module; 0 for the module as a whole
};

struct LintFinding {
    Severity severity = Severity::Warning;
    std::string rule;  // stable name, for instance "query-proceeds"
    SpirvPlace place;
    std::string message;  // one sentence without a full stop
    std::string hint;     // advice
};

// Returns "in main (shader.comp:12, word 214)", or an empty text for the module as a whole.
std::string toString(const SpirvPlace& place);

struct SpirvLint {
    SpirvStatistics statistics;
    std::vector<std::string> stages;    // execution models of the entry points, "GLCompute", "ClosestHitKHR"
    std::vector<LintFinding> findings;  // in the order of the module
};

// Inlines and folds a copy of the module, as a driver would, and applies the rules to it. Errors:
// "spirv-format" if `words` is no SPIR-V module, "spirv-invalid" with the validator's message.
Result<SpirvLint> lintSpirv(std::span<const std::uint32_t> words);

}  // namespace glint::compiler
