// Encodes and decodes PNG in memory.
#pragma once

#include "base/files.h"

#include <glint/image.h>
#include <glint/result.h>

#include <cstdint>
#include <span>
#include <string>

namespace glint::image {

// 8-bit RGB, with the first row on top.
struct DisplayImage {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<std::array<std::uint8_t, 3>> pixels;
};

// The result is deterministic. Error "png-encode"; `where` names the file in the message.
Result<base::Bytes> encodePng(const DisplayImage& image, const std::string& where);

// Decodes 8 or 16 bits a channel, grey or colour. Colours are taken as sRGB and made linear; alpha is as
// stored. Errors "image-format", "image-size".
Result<LinearImage> decodePng(std::span<const std::uint8_t> bytes, const std::string& where);

}  // namespace glint::image
