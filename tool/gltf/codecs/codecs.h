// The image formats that Glint decodes, which it recognises by their first bytes.
#pragma once

#include "gltf/codecs/block_file.h"
#include "gltf/scene.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace glint::gltf {

// Describes one format. Both functions return false on failure, and `problem` then has the decoder's message.
struct Codec {
    const char* name;
    const char* type;  // the media type
    // Sets the image's size and format. It allocates nothing that depends on them.
    bool (*readHeader)(ByteView bytes, Image& image, std::string& problem);
    // Fills the pixels of an image. Its header must have been read from the same bytes, and its size must
    // have been accepted.
    bool (*decode)(ByteView bytes, Image& image, std::string& problem);
};

extern const Codec kPng;
extern const Codec kJpeg;
extern const Codec kWebp;
// KTX2 and DDS. In a build without hasBasisu(), decode() fails for data that need it, and says why.
extern const Codec kBasisu;
extern const Codec kDds;

// Reads a file of the two by its first bytes. Returns nothing for a damaged file or one whose data Glint does
// not read, and `problem` says why. Allocates nothing that depends on the file's sizes.
std::optional<BlockFile> readBlockFile(ByteView bytes, std::string& problem);

// Returns all levels in their block format, one after the other. `file` must have been read from `bytes` and
// have a format. Returns nothing if Zstandard data are damaged, and `problem` says so.
std::optional<std::vector<std::uint8_t>> blocksOf(const BlockFile& file, ByteView bytes,
                                                  std::string& problem);

// Returns the codec that matches the first bytes, or null if there is none.
const Codec* findCodec(ByteView bytes);

// Returns the name of the format if Glint recognises it but does not read it, and an empty text otherwise.
const char* foreignFormat(ByteView bytes);

}  // namespace glint::gltf
