// Walks the instructions of a SPIR-V module (SPIR-V specification 1.6, section 2.3), bounds-checked.
#pragma once

#include <glint/result.h>

#include <cstdint>
#include <functional>
#include <span>
#include <string>

namespace glint {

struct SpirvInstruction {
    std::uint32_t opcode = 0;
    std::span<const std::uint32_t> operands;  // every word after the first
};

// Calls `visit` for each instruction in order. Error "spirv-format" where `words` is no SPIR-V module or an
// instruction runs past its end; those before it have been visited.
Status visitSpirv(std::span<const std::uint32_t> words,
                  const std::function<void(const SpirvInstruction&)>& visit);

// A literal string (UTF-8, four bytes a word, zero-terminated) at the start of `operands`; ends with them
// where the terminator is missing.
std::string spirvString(std::span<const std::uint32_t> operands);

}  // namespace glint
