// Finds the place of instructions in a module: function, source line, ID.
#pragma once

#include "spirv/lint.h"
#include "spirv/reader.h"

#include <functional>
#include <map>
#include <vector>

namespace glint::compiler {

// Returns the offset of the first word of `instruction`, which visitSpirv() gave for `words`.
inline std::size_t offsetOf(std::span<const std::uint32_t> words, const SpirvInstruction& instruction) {
    return static_cast<std::size_t>(instruction.operands.data() - words.data()) - 1;
}

// Requires a module that visitSpirv() walks to its end.
void forEachInstruction(std::span<const std::uint32_t> words,
                        const std::function<void(const SpirvInstruction&)>& visit);

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
