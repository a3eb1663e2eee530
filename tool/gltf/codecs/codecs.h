// The image formats that Glint decodes, which it recognises by their first bytes.
#pragma once

#include "gltf/document/document.h"
#include "gltf/scene.h"

#include <string>

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

// Returns the codec that matches the first bytes, or null if there is none.
const Codec* findCodec(ByteView bytes);

// Returns the name of the format if Glint recognises it but does not read it, and an empty text otherwise.
const char* foreignFormat(ByteView bytes);

}  // namespace glint::gltf
