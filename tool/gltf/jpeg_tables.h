// What stb_image takes on trust in a JPEG file: up to 2.27 it writes behind its own tables for a Huffman
// table of more than 256 codes, and every scan costs it a pass over all blocks, however few bytes the scan
// has.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace glint::gltf {

// Why the file must not be decoded; empty where every table that a decoder can come to has at most 256 codes
// and lies in its segment, and where there are at most 256 scans. Layout: ITU-T T.81, B.2.4.2.
std::string findJpegExcess(std::span<const std::uint8_t> bytes);

}  // namespace glint::gltf
