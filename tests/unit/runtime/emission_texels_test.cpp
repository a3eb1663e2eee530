// Tests the means of emissive textures, without a device.
#include "data/emitters.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

namespace glint {
namespace {

constexpr std::uint32_t kRepeat = 0;
constexpr std::uint32_t kClamp = 1;

// Black but for the texels [first, last] of each row, which are white.
std::vector<std::uint8_t> whiteColumns(std::uint32_t width, std::uint32_t height, std::uint32_t first,
                                       std::uint32_t last) {
    std::vector<std::uint8_t> pixels;
    for (std::uint32_t i = 0; i < width * height; ++i) {
        const bool isWhite = i % width >= first && i % width <= last;
        const std::uint8_t value = isWhite ? 255 : 0;
        pixels.insert(pixels.end(), {value, value, value, 255});
    }
    return pixels;
}

EmissionTexels texelsOf(std::uint32_t width, std::uint32_t height, const std::vector<std::uint8_t>& pixels,
                        bool isColor = true) {
    return {ImageView{width, height, pixels}, isColor};
}

TEST(EmissionTexels, TheMeanIsThatOfTheBox) {
    const std::vector<std::uint8_t> pixels = whiteColumns(64, 64, 32, 63);
    const EmissionTexels texels = texelsOf(64, 64, pixels);
    EXPECT_NEAR(texels.mean(), 0.5, 1e-6);
    EXPECT_NEAR(texels.mean({{0.6, 0.1}, {0.9, 0.3}}, kClamp, kClamp), 1.0, 1e-6);
    EXPECT_EQ(texels.mean({{0.1, 0.1}, {0.4, 0.3}}, kClamp, kClamp), 0.0);
    EXPECT_NEAR(texels.mean({{0.0, 0.0}, {1.0, 1.0}}, kClamp, kClamp), 0.5, 0.02);
    // The filter reaches the next texel.
    EXPECT_GT(texels.mean({{0.1, 0.1}, {0.495, 0.3}}, kClamp, kClamp), 0.0);
    // A box beyond the edge sees the other side of a texture that repeats.
    EXPECT_EQ(texels.mean({{1.1, 0.1}, {1.4, 0.3}}, kRepeat, kRepeat), 0.0);
    EXPECT_NEAR(texels.mean({{1.1, 0.1}, {1.4, 0.3}}, kClamp, kClamp), 1.0, 1e-6);
    EXPECT_GT(texels.mean({{0.9, 0.1}, {1.4, 0.3}}, kRepeat, kRepeat), 0.0);
    EXPECT_GT(texels.mean({{-7.0, -INFINITY}, {80.0, NAN}}, kRepeat, kRepeat), 0.0);
}

// One white texel of an image whose sides are no powers of two is in the mean of every box that holds it.
TEST(EmissionTexels, IsNeverBlackWhereATexelIsNot) {
    constexpr std::uint32_t kWidth = 117;
    constexpr std::uint32_t kHeight = 45;
    std::vector<std::uint8_t> pixels = whiteColumns(kWidth, kHeight, 1, 0);
    const std::uint32_t x = 93;
    const std::uint32_t y = 31;
    pixels[4 * (y * kWidth + x) + 1] = 1;
    const EmissionTexels texels = texelsOf(kWidth, kHeight, pixels);
    const double u = (x + 0.5) / kWidth;
    const double v = (y + 0.5) / kHeight;
    for (const double size : {0.0, 0.01, 0.1, 0.3, 0.7}) {
        EXPECT_GT(texels.mean({{u - size, v - size}, {u + 0.1 * size, v + 0.2 * size}}, kRepeat, kRepeat),
                  0.0)
            << size;
    }
    EXPECT_GT(texels.mean(), 0.0);
}

// A large image keeps its coarser levels alone, which lose no texel either.
TEST(EmissionTexels, LargeImagesAreKeptCoarsely) {
    constexpr std::uint32_t kWidth = 1030;
    constexpr std::uint32_t kHeight = 515;
    std::vector<std::uint8_t> pixels = whiteColumns(1024, 512, 512, 1023);
    const EmissionTexels half = texelsOf(1024, 512, pixels);
    EXPECT_NEAR(half.mean(), 0.5, 1e-6);
    EXPECT_NEAR(half.mean({{0.6, 0.1}, {0.9, 0.3}}, kClamp, kClamp), 1.0, 1e-6);
    EXPECT_EQ(half.mean({{0.1, 0.1}, {0.4, 0.3}}, kClamp, kClamp), 0.0);
    pixels = whiteColumns(kWidth, kHeight, 1, 0);
    pixels[4 * (std::size_t{514} * kWidth + 1029)] = 1;
    const EmissionTexels one = texelsOf(kWidth, kHeight, pixels);
    EXPECT_GT(one.mean({{0.9995, 0.9995}, {1.0, 1.0}}, kClamp, kClamp), 0.0);
    EXPECT_GT(one.mean(), 0.0);
}

TEST(EmissionTexels, ColoursAreLinearised) {
    const std::vector<std::uint8_t> grey(4, 188);
    EXPECT_NEAR(texelsOf(1, 1, grey).mean(), 0.503, 1e-3);
    EXPECT_NEAR(texelsOf(1, 1, grey, false).mean(), 188.0 / 255.0, 1e-6);
}

}  // namespace
}  // namespace glint
