// Unpacks blocks of ETC2 and EAC: Khronos Data Format Specification 1.3, section 21.
#pragma once

#include "gltf/codecs/basisu.h"

namespace glint::gltf {

// Sets red, green, blue and alpha. `punchThrough`: alpha of 0 or 1, as RGBA1 has it.
void unpackEtc2(const std::uint8_t* block, bool punchThrough, BlockTexels& texels);
// Sets one channel by a block of EAC: with 8 bits, as the alpha of RGBA has it, or with 11, rounded to 8.
void unpackEac(const std::uint8_t* block, bool has11Bits, std::size_t channel, BlockTexels& texels);

}  // namespace glint::gltf
