// The image formats that Glint decodes, which it recognises by their first bytes.
#pragma once

#include "gltf/document/files.h"
#include "gltf/scene.h"

#include <glint/result.h>
#include <glint/scene_view.h>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace glint::gltf {

// Returns the fault of a file. Its place and a hint are added where the image is known.
inline Diagnostic imageFault(std::string message) {
    return makeError("image-decode", "", std::move(message));
}

// Describes one format. The errors of both functions have the decoder's message (imageFault()).
struct Codec {
    const char* name;
    const char* type;  // the media type
    // Sets the image's size and format. It allocates nothing that depends on them.
    Status (*readHeader)(ByteView bytes, Image& image);
    // Fills the pixels of an image. Its header must have been read from the same bytes, and its size must
    // have been accepted.
    Status (*decode)(ByteView bytes, Image& image);
};

extern const Codec kPng;
extern const Codec kJpeg;
extern const Codec kWebp;
// KTX2 and DDS. In a build without hasBasisu(), decode() fails for data that need it, and says why.
extern const Codec kBasisu;
extern const Codec kDds;

// Returns the codec that matches the first bytes, or null if there is none.
const Codec* findCodec(ByteView bytes);

// Returns the name of the format if Glint recognises it but does not read it, and an empty text otherwise.
const char* foreignFormat(ByteView bytes);

// ---- KTX2 and DDS files ----

// The checked header of a file: every level lies in the file and is as long as its blocks are. DDS files are
// 2D and hold blocks.
struct BlockFile : ImageShape {
    Transfer transfer = Transfer::Unknown;
    std::optional<TexelFormat> format;  // none: data of Basis Universal
    int channels = 4;                   // that each texel has in the file, in Rgba8 and Rgba16
    bool hasAlpha = true;               // false: alpha is 1 whatever the blocks say
    bool isZstandard = false;           // each level is compressed by Zstandard
    struct Level {
        std::uint64_t offset = 0;  // bytes
        std::uint64_t bytes = 0;
    };
    std::vector<Level> places;  // of each level, from the largest
    // Where the file breaks rules, and what Glint does then; each is one clause.
    std::vector<std::string> deviations;
};

// Reads a file of the two by its first bytes. Allocates nothing that depends on the file's sizes.
Result<BlockFile> readBlockFile(ByteView bytes);

// Returns the bytes of a level with all of its layers, each in whole blocks.
constexpr std::uint64_t levelBytes(const ImageShape& shape, TexelFormat format, int level) {
    return bytesOfLevel(format, static_cast<std::uint32_t>(shape.width),
                        static_cast<std::uint32_t>(shape.height), static_cast<std::uint32_t>(level)) *
           static_cast<std::uint64_t>(layersOfLevel(shape, level));
}

// Returns all levels as they are stored, one after the other. `file` must have been read from `bytes` and
// have a format.
Result<base::Bytes> blocksOf(const BlockFile& file, ByteView bytes);

// Returns width * height pixels of a level, row by row from the top; `blocks` has bytesOfLevel() bytes. A
// colour that the format lacks is 0, and alpha 1, as a shader reads them. `srgb`: colours are in sRGB, and
// stay so. The error says that this build lacks what BC7 and ASTC need (hasBasisu()).
Result<base::Bytes> decodeBlocks(TexelFormat format, bool srgb, std::uint32_t width, std::uint32_t height,
                                 ByteView blocks);

// ---- Basis Universal: transcodes KTX2 images (KHR_texture_basisu), and encodes and decodes blocks ----
//
// Not every build has the sources that this needs: functions that can fail then do, and others do nothing.

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
