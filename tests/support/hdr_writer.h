// Writes Radiance RGBE pictures for tests. The format is described in Ward, "Real Pixels" (Graphics Gems II,
// 1991).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace glint::testing {

enum class HdrEncoding { Flat, RunLength };

inline std::array<std::uint8_t, 4> toRgbe(const std::array<float, 3>& color) {
    const float most = std::max({color[0], color[1], color[2]});
    if (most <= 0.0F) {
        return {};
    }
    int exponent = 0;
    const float scale = std::frexp(most, &exponent) * 256.0F / most;
    return {static_cast<std::uint8_t>(color[0] * scale), static_cast<std::uint8_t>(color[1] * scale),
            static_cast<std::uint8_t>(color[2] * scale), static_cast<std::uint8_t>(exponent + 128)};
}

// Run-length encoding needs a width of 8 to 32767. This code writes no runs, but pieces of at most 128 bytes.
inline std::vector<std::uint8_t> encodeHdr(int width, int height,
                                           const std::vector<std::array<float, 3>>& pixels,
                                           HdrEncoding encoding) {
    const std::string header = "#?RADIANCE\n# made by a test\nFORMAT=32-bit_rle_rgbe\n\n-Y " +
                               std::to_string(height) + " +X " + std::to_string(width) + "\n";
    std::vector<std::uint8_t> bytes(header.begin(), header.end());
    for (int y = 0; y < height; ++y) {
        std::vector<std::array<std::uint8_t, 4>> row;
        row.reserve(static_cast<std::size_t>(width));
        for (int x = 0; x < width; ++x) {
            row.push_back(toRgbe(pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                        static_cast<std::size_t>(x)]));
        }
        if (encoding == HdrEncoding::Flat) {
            for (const auto& pixel : row) {
                bytes.insert(bytes.end(), pixel.begin(), pixel.end());
            }
            continue;
        }
        bytes.insert(bytes.end(),
                     {2, 2, static_cast<std::uint8_t>(width / 256), static_cast<std::uint8_t>(width % 256)});
        for (std::size_t channel = 0; channel < 4; ++channel) {
            for (std::size_t x = 0; x < row.size(); ++x) {
                if (x % 128 == 0) {
                    bytes.push_back(static_cast<std::uint8_t>(std::min<std::size_t>(row.size() - x, 128)));
                }
                bytes.push_back(row[x][channel]);
            }
        }
    }
    return bytes;
}

}  // namespace glint::testing
