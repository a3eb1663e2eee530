// OpenEXR in memory.
#pragma once

#include "base/files.h"

#include <glint/renderer.h>
#include <glint/result.h>

#include <span>
#include <string>

namespace glint {

// 32-bit float RGBA, ZIP compressed, scan lines from the top: no loss. Error "exr-encode".
Result<Bytes> encodeExr(const LinearImage& image, const std::string& where);

// The data window of a single-part scan-line or tiled file with channels R, G, B and perhaps A (1 where it is
// missing), of any pixel type. Errors "image-format", "image-size".
Result<LinearImage> decodeExr(std::span<const std::uint8_t> bytes, const std::string& where);

}  // namespace glint
