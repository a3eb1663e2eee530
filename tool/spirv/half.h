// Turns arithmetic that a module marks with relaxed precision into 16-bit float arithmetic.
#pragma once

#include <cstdint>
#include <vector>

namespace glint::compiler {

// Returns whether anything in the module may have fewer than 32 bits, as GLSL's mediump allows.
bool relaxesPrecision(const std::vector<std::uint32_t>& words);

// SPIRV-Tools 2023.1 treats every float that OpCompositeExtract takes out of a structure or an array as
// relaxed, even the positions of lights: its pass asks whether all float operands are relaxed, and there is
// none. hideExtractions() hides such instructions from that pass as instructions with the same layout that it
// ignores, and showExtractions() brings them back. No other pass may run in between, because the hidden
// instructions mean nothing.
void hideExtractions(std::vector<std::uint32_t>& words);
void showExtractions(std::vector<std::uint32_t>& words);

}  // namespace glint::compiler
