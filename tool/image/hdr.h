// Decodes Radiance RGBE pictures (.hdr) in memory.
#pragma once

#include "base/files.h"

#include <glint/image.h>
#include <glint/result.h>

#include <span>
#include <string>

namespace glint::image {

// Returns linear RGB with alpha 1, first row on top. Files may be run-length encoded or flat, in the format
// 32-bit_rle_rgbe with the orientation -Y +X. EXPOSURE is not applied. Errors "image-format", "image-size".
Result<LinearImage> decodeHdr(std::span<const std::uint8_t> bytes, const std::string& where);

}  // namespace glint::image
