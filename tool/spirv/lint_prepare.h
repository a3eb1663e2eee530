// Makes a module ready for the rules about ray queries: checked, inlined, folded.
#pragma once

#include <glint/result.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace glint {

// Error "spirv-invalid" with the validator's first message, for any version of SPIR-V that it knows.
Status checkSpirv(std::span<const std::uint32_t> words);

// A copy in which what a driver inlines and folds is inlined and folded: functions with ray queries, and
// small ones. Before each of its ray query instructions stands an OpLine whose line is the offset of the
// original instruction in `words`. Requires a valid module.
std::vector<std::uint32_t> prepareForLint(std::span<const std::uint32_t> words);

}  // namespace glint
