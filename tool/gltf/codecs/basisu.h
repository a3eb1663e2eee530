// Basis Universal: transcodes KTX2 images (KHR_texture_basisu), and encodes and decodes blocks. Not
// every build has the sources that this needs: functions that can fail then do, and others do nothing.
#pragma once

#include "gltf/codecs/codecs.h"

#include <array>
#include <cstdint>
#include <span>

namespace glint::gltf {

// Returns whether the sources of Basis Universal were present at configuration.
bool hasBasisu();

// Tells users what to do in a build that does not have them.
inline constexpr const char* kBasisuHint =
    "run scripts/setup.sh, which fetches the transcoder of Basis Universal, and build Glint again; or store "
    "the image as PNG, JPEG or WebP";

// Fills the pixels of an image whose header was read from a KTX2 file without a block format of its own.
Status decodeBasis(ByteView bytes, Image& image);

// Returns all levels of such a file in BC1, BC3, BC7 or ASTC 4x4. Other formats are errors.
Result<base::Bytes> transcodeBasis(const BlockFile& file, ByteView bytes, TexelFormat format);

// A block of 4 x 4 texels in RGBA of 8 bits, row by row.
using BlockTexels = std::array<std::array<std::uint8_t, 4>, 16>;

// Unpacks a block of BC7.
void unpackBc7(const std::uint8_t* block, BlockTexels& texels);
// Unpacks a block of ASTC to width * height texels. Values are those that a device reads of the format with
// colours in sRGB or without. Blocks that are not valid, or hold numbers above 1, are magenta.
void unpackAstc(const std::uint8_t* block, std::uint32_t width, std::uint32_t height, bool srgb,
                std::uint8_t* texels);
// Packs a block: Bc1 (alpha is lost), Bc3, Bc4, Bc5 (of the given channels) or Bc7.
void packBlock(TexelFormat format, const BlockTexels& texels, const std::array<int, 2>& channels,
               std::uint8_t* block);

// Unpacks data that must be as long as `to`.
bool unpackZstandard(ByteView from, std::span<std::uint8_t> to);

}  // namespace glint::gltf
