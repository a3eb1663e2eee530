// Checks the statements of a DDS file about itself.
#pragma once

#include "gltf/codecs/block_file.h"

namespace glint::gltf {

// Accepts one two-dimensional image in BC1 to BC5 or BC7 with unsigned values: by the header's FourCC (DXT1
// to DXT5, ATI1, ATI2, BC4U, BC5U) or by a DX10 header. Source: Microsoft, "Programming Guide for DDS".
std::optional<BlockFile> readDds(ByteView bytes, std::string& problem);

}  // namespace glint::gltf
