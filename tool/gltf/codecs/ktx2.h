// Checks the statements of a KTX2 file about itself before a decoder sees any of it.
#pragma once

#include "gltf/document/document.h"
#include "gltf/scene.h"

#include <optional>
#include <string>
#include <vector>

namespace glint::gltf {

// A KTX2 file of Basis Universal data. Every length and offset lies in the file, and every level is as long
// as its blocks are.
struct Ktx2 {
    int width = 0;  // all sizes are in pixels
    int height = 0;
    int levels = 0;  // from 1 up to the levels of a full pyramid
    Transfer transfer = Transfer::Unknown;
    // Where the file breaks the rules of KHR_texture_basisu, and what Glint does then; each is one clause.
    std::vector<std::string> deviations;
};

// Accepts one two-dimensional image in ETC1S (with BasisLZ) or UASTC (uncompressed or with Zstandard). For a
// damaged file or other data it returns nothing, and `problem` says why. It allocates nothing that depends on
// the file. Sources: KTX File Format Specification 2.0, sections 3 and 4; Khronos Data Format 1.3, section 5.
std::optional<Ktx2> readKtx2(ByteView bytes, std::string& problem);

// This is Codec::readHeader for KTX2.
bool readKtx2Header(ByteView bytes, Image& image, std::string& problem);

}  // namespace glint::gltf
