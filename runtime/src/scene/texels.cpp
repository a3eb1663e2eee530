#include "scene/texels.h"

#include <cmath>
#include <cstddef>
#include <cstring>

namespace glint {
namespace {

constexpr double kLargest16 = 65535.0;

// The electro-optical transfer function of IEC 61966-2-1.
double decodeSrgb(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

std::vector<std::uint16_t> makeLinearTable() {
    std::vector<std::uint16_t> table(65536);
    for (std::size_t i = 0; i < table.size(); ++i) {
        table[i] = static_cast<std::uint16_t>(
            std::lround(decodeSrgb(static_cast<double>(i) / kLargest16) * kLargest16));
    }
    return table;
}

}  // namespace

std::vector<std::uint8_t> linearizeRgba16(std::span<const std::uint8_t> texels) {
    const std::vector<std::uint16_t> table = makeLinearTable();
    std::vector<std::uint8_t> linear(texels.begin(), texels.end());
    for (std::size_t i = 0; i + 8 <= linear.size(); i += 8) {
        std::uint16_t color[3];
        std::memcpy(color, &linear[i], sizeof color);
        for (std::uint16_t& channel : color) {
            channel = table[channel];
        }
        std::memcpy(&linear[i], color, sizeof color);
    }
    return linear;
}

std::vector<std::uint8_t> narrowRgba16(std::span<const std::uint8_t> texels) {
    std::vector<std::uint8_t> narrow(texels.size() / 2);
    for (std::size_t i = 0; i < narrow.size(); ++i) {
        std::uint16_t channel = 0;
        std::memcpy(&channel, &texels[2 * i], sizeof channel);
        // 65535 = 255 * 257, and adding 128 rounds to the nearest.
        narrow[i] = static_cast<std::uint8_t>((channel + 128U) / 257U);
    }
    return narrow;
}

}  // namespace glint
