// Prepares a module for the lint rules: checks, inlines and folds it, and finds the place of its
// instructions.
#pragma once

#include "spirv/lint.h"
#include "spirv/reader.h"

#include <glint/result.h>

#include <cstddef>
#include <cstdint>
#include <map>
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

bool isRayQueryInstruction(std::uint32_t opcode);
bool isTraceInstruction(std::uint32_t opcode);

struct SpirvEntryPoint {
    std::uint32_t model = 0;
    std::uint32_t function = 0;
    std::string name;
};

// Requires a valid module.
std::vector<SpirvEntryPoint> findEntryPoints(std::span<const std::uint32_t> words);

// Returns the places of all ray queries and traces, by offset. Requires a valid module.
std::map<std::size_t, SpirvPlace> findPlaces(std::span<const std::uint32_t> words);

}  // namespace glint::compiler
