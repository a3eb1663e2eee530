// Encodes and decodes OpenEXR in memory.
#pragma once

#include "base/files.h"

#include <glint/renderer.h>
#include <glint/result.h>

#include <span>
#include <string>

namespace glint::image {

// Encodes 32-bit float RGBA, ZIP compressed, scan lines from the top. Nothing is lost. Error "exr-encode".
Result<base::Bytes> encodeExr(const LinearImage& image, const std::string& where);

// Decodes the data window of a single-part scan-line or tiled file. It has channels R, G, B and optionally A
// (1 if it is missing), of any pixel type. Errors "image-format", "image-size".
Result<LinearImage> decodeExr(std::span<const std::uint8_t> bytes, const std::string& where);

}  // namespace glint::image
