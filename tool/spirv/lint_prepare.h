// Prepares a module for the rules about ray queries: checks, inlines and folds it.
#pragma once

#include <glint/result.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace glint::compiler {

// Returns the error "spirv-invalid" with the validator's first message. It accepts any version of SPIR-V that
// the validator knows.
Status checkSpirv(std::span<const std::uint32_t> words);

// Returns a copy in which everything that a driver inlines and folds is inlined and folded: functions with
// ray queries, and small ones. Before each ray query instruction stands an OpLine whose line is the offset of
// the original instruction in `words`. Requires a valid module.
std::vector<std::uint32_t> prepareForLint(std::span<const std::uint32_t> words);

}  // namespace glint::compiler
