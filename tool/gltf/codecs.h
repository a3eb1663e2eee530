// The image formats that Glint decodes, found by their first bytes.
#pragma once

#include "gltf/document.h"
#include "gltf/scene.h"

#include <string>

namespace glint::gltf {

// One format. Both functions are false on failure, with what the decoder said in `problem`.
struct Codec {
    const char* name;
    // Sets the image's size and format; allocates nothing by them.
    bool (*readHeader)(ByteView bytes, Image& image, std::string& problem);
    // Fills the pixels of an image whose header was read from the same bytes, and found to be of a size that
    // may be allocated.
    bool (*decode)(ByteView bytes, Image& image, std::string& problem);
};

extern const Codec kPng;
extern const Codec kJpeg;
extern const Codec kWebp;
// In a build without hasBasisu() its decode() fails, and says why.
extern const Codec kBasisu;

// The codec for what the bytes start with; null for none.
const Codec* findCodec(ByteView bytes);

// The name of what the bytes hold, where it is a format that Glint knows and does not read; empty otherwise.
const char* foreignFormat(ByteView bytes);

}  // namespace glint::gltf
