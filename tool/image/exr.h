// Encodes and decodes OpenEXR in memory.
#pragma once

#include "base/files.h"

#include <glint/image.h>
#include <glint/result.h>

#include <cstdint>
#include <span>
#include <string>

namespace glint::image {

// Returns the first element that does not fit. Returns an empty text if everything fits, or if the library
// would not read the file any further.
std::string findExrExcess(std::span<const std::uint8_t> bytes);

// An image in a file beside the picture. Its channels are called "NAME.C", by the conventions of OpenEXR for
// layers.
struct ExrLayer {
    std::string name;
    std::string channels;  // one letter each
    bool isHalf = false;   // reals are written as 16-bit floats
    LayerValues values;    // of the size of the picture; components beyond the channels are left out
};

// Encodes 32-bit float RGBA, ZIP compressed, scan lines from the top. Nothing is lost. Error "exr-encode".
Result<base::Bytes> encodeExr(const LinearImage& image, const std::string& where,
                              std::span<const ExrLayer> layers = {});

// Decodes the data window of a single-part scan-line or tiled file. It has channels R, G, B and optionally A
// (1 if it is missing), of any pixel type. Errors "image-format", "image-size".
Result<LinearImage> decodeExr(std::span<const std::uint8_t> bytes, const std::string& where);

}  // namespace glint::image
