// The image formats that Glint decodes, which it recognises by their first bytes.
#pragma once

#include "gltf/codecs/block_file.h"
#include "gltf/scene.h"

#include <cstdint>

namespace glint::gltf {

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

// Reads a file of the two by its first bytes. Allocates nothing that depends on the file's sizes.
Result<BlockFile> readBlockFile(ByteView bytes);

// Returns all levels in their block format, one after the other. `file` must have been read from `bytes` and
// have a format.
Result<base::Bytes> blocksOf(const BlockFile& file, ByteView bytes);

// Returns the codec that matches the first bytes, or null if there is none.
const Codec* findCodec(ByteView bytes);

// Returns the name of the format if Glint recognises it but does not read it, and an empty text otherwise.
const char* foreignFormat(ByteView bytes);

}  // namespace glint::gltf
