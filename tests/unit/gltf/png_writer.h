// Writes uncompressed PNG files of every kind, for tests of reading them.
#pragma once

#include "base/files.h"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace glint::test {

enum class PngColor : std::uint8_t { Gray = 0, Rgb = 2, Palette = 3, GrayAlpha = 4, Rgba = 6 };

struct PngSpec {
    std::uint32_t width = 1;
    std::uint32_t height = 1;
    std::uint8_t bitDepth = 8;
    PngColor color = PngColor::Rgba;
    // The chunks between IHDR and IDAT, type and content: PLTE, tRNS.
    std::vector<std::pair<std::string, base::Bytes>> chunks;
    base::Bytes rows;  // as PNG stores them, big-endian, without the filter byte of each row
};

// The rows have width * channels * bitDepth / 8 bytes each, rounded up.
base::Bytes makePng(const PngSpec& spec);

}  // namespace glint::test
