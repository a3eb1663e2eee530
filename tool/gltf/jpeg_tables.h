// Huffman tables of JPEG files: stb_image, up to 2.27, writes behind its own for one of more than 256 codes.
#pragma once

#include <cstdint>
#include <span>

namespace glint::gltf {

// Whether every table that a decoder can come to has at most 256 codes, and lies in its segment. Layout:
// ITU-T T.81, B.2.4.2.
bool hasSoundTables(std::span<const std::uint8_t> bytes);

}  // namespace glint::gltf
