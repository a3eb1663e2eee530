// What a KTX2 file says of itself, checked before a decoder sees any of it.
#pragma once

#include "gltf/document.h"
#include "gltf/scene.h"

#include <optional>
#include <string>
#include <vector>

namespace glint::gltf {

// A KTX2 file of Basis Universal data. Every length and offset of it has been found to lie in the file, and
// every level to be as long as its blocks are.
struct Ktx2 {
    int width = 0;  // pixels, as all sizes
    int height = 0;
    int levels = 0;  // 1, up to those of a full pyramid
    Transfer transfer = Transfer::Unknown;
    // Where it says what KHR_texture_basisu does not allow, and what Glint does all the same; a clause each.
    std::vector<std::string> deviations;
};

// Nothing, and why in `problem`, where it is damaged or holds other data than one two-dimensional image in
// ETC1S (with BasisLZ) or UASTC (as it is, or with Zstandard). Allocates nothing by what the file says.
// Source: KTX File Format Specification 2.0, sections 3 and 4; Khronos Data Format 1.3, section 5.
std::optional<Ktx2> readKtx2(ByteView bytes, std::string& problem);

// The same as Codec::readHeader.
bool readKtx2Header(ByteView bytes, Image& image, std::string& problem);

}  // namespace glint::gltf
