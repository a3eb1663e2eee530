// Checks the statements of a KTX2 file about itself before a decoder sees any of it.
#pragma once

#include "gltf/codecs/block_file.h"

namespace glint::gltf {

// Accepts one two-dimensional image: in ETC1S (with BasisLZ) or UASTC, as KHR_texture_basisu wants it, or in
// BC1 to BC5, BC7, ETC2, EAC or ASTC, which is a deviation. Data other than ETC1S may be compressed by
// Zstandard. For a damaged file or other data it returns nothing, and `problem` says why. It allocates
// nothing that depends on the file. Sources: KTX File Format Specification 2.0, sections 3 and 4; Khronos
// Data Format 1.3, section 5.
std::optional<BlockFile> readKtx2(ByteView bytes, std::string& problem);

}  // namespace glint::gltf
