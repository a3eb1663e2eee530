// 16-bit float arithmetic out of what a module marks as of relaxed precision.
#pragma once

#include <cstdint>
#include <vector>

namespace glint {

// Whether anything in the module may have less than 32 bits: GLSL's mediump.
bool relaxesPrecision(const std::vector<std::uint32_t>& words);

// SPIRV-Tools 2023.1 takes every float that OpCompositeExtract takes out of a structure or an array for one
// of relaxed precision, positions of lights, too (its pass asks whether all float operands are relaxed, and
// there is none). These two hide such instructions from that pass, as one of the same layout that it does not
// touch, and bring them back. For no other pass between them: the hidden ones mean nothing.
void hideExtractions(std::vector<std::uint32_t>& words);
void showExtractions(std::vector<std::uint32_t>& words);

}  // namespace glint
