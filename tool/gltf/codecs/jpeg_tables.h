// Checks a JPEG file for two things that stb_image does not check. Up to version 2.27 it writes behind its
// own tables for a Huffman table of more than 256 codes. Every scan also costs it a pass over all blocks,
// however few bytes the scan has.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace glint::gltf {

// Returns why the file must not be decoded. The text is empty if there are at most 256 scans, and if every
// table that a decoder can reach has at most 256 codes and lies in its segment. The layout is that of ITU-T
// T.81, B.2.4.2.
std::string findJpegExcess(std::span<const std::uint8_t> bytes);

}  // namespace glint::gltf
