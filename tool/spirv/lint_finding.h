// A finding of the lint rules in a SPIR-V module, and its place.
#pragma once

#include <glint/result.h>

#include <cstddef>
#include <cstdint>
#include <string>

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

}  // namespace glint::compiler
