#include "image.h"

#include "noise.h"
#include "support/must.h"
#include "textures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace gallery::test {

namespace {

// Returns the pixel at (x, y), red first.
std::array<int, 3> pixel(const Image& image, int x, int y) {
    const auto at = static_cast<std::size_t>(y * image.width + x) * static_cast<std::size_t>(image.channels);
    return {image.pixels[at], image.pixels[at + 1], image.pixels[at + 2]};
}

// Returns the sum of the red channel over a rectangle.
long long brightness(const Image& image, int x0, int y0, int x1, int y1) {
    long long sum = 0;
    for (int y = y0; y < y1; ++y) {
        for (int x = x0; x < x1; ++x) {
            sum += pixel(image, x, y)[0];
        }
    }
    return sum;
}

}  // namespace

TEST(NormalMap, LeansAwayFromTheSlope) {
    const HeightField ramp =
        sculpt(64, [](const glm::vec2& uv) { return uv.x < 0.5F ? 0.5F * uv.x : 0.5F * (1.0F - uv.x); });
    const Image image = normalMap(ramp);
    EXPECT_LT(pixel(image, 16, 32)[0], 100);  // rises to the right, so the normal leans left
    EXPECT_GT(pixel(image, 48, 32)[0], 155);
    EXPECT_NEAR(pixel(image, 16, 32)[1], 128, 1);
}

TEST(NormalMap, GreenPointsUpTheImage) {
    const HeightField hill =
        sculpt(64, [](const glm::vec2& uv) { return uv.y < 0.5F ? 0.5F * uv.y : 0.5F * (1.0F - uv.y); });
    const Image image = normalMap(hill);
    EXPECT_GT(pixel(image, 32, 16)[1], 155);  // upper half: the slope falls towards the upper edge
    EXPECT_LT(pixel(image, 32, 48)[1], 100);
    EXPECT_NEAR(pixel(image, 32, 16)[0], 128, 1);
}

TEST(Noise, RepeatsAtTheBorders) {
    for (const float v : {0.1F, 0.37F, 0.9F}) {
        EXPECT_NEAR(fractalNoise({0.0F, v}, {4, 3}, 4, 7), fractalNoise({1.0F, v}, {4, 3}, 4, 7), 1e-4F);
        EXPECT_NEAR(fractalNoise({v, 0.0F}, {4, 3}, 4, 7), fractalNoise({v, 1.0F}, {4, 3}, 4, 7), 1e-4F);
        EXPECT_NEAR(cellDistance({0.0F, v}, 8, 7), cellDistance({1.0F, v}, 8, 7), 1e-4F);
    }
    EXPECT_NE(fractalNoise({0.21F, 0.3F}, {4, 4}, 4, 7), fractalNoise({0.21F, 0.3F}, {4, 4}, 4, 8));
}

TEST(Textures, FloorIsMirrorSmoothOnItsTiles) {
    const Image image = floorMetallicRoughness();
    // This is the middle of a tile: there are 4 x 4 tiles over 512 pixels.
    for (int tile = 0; tile < 4; ++tile) {
        const std::array<int, 3> texel = pixel(image, 64 + 128 * tile, 64);
        EXPECT_LE(texel[1], 13);  // 0.05
        EXPECT_EQ(texel[2] > 128, tile % 2 == 0);
    }
}

TEST(Textures, SignReadsFromLeftToRight) {
    const Image image = signColor();
    // The arrow's head is at the right end of the lower half; its tail at the left is thinner.
    EXPECT_GT(brightness(image, 400, 160, 470, 256), brightness(image, 42, 160, 112, 256));
    // L is dark at its upper right and bright at its lower right. Neither is true of a flipped image.
    EXPECT_GT(brightness(image, 180, 125, 205, 145), brightness(image, 180, 30, 205, 50));
}

TEST(Textures, CutOutsHaveBothAlphas) {
    for (const Image& image : {screenColor(), lanternColor()}) {
        ASSERT_EQ(image.channels, 4);
        std::size_t open = 0;
        for (std::size_t at = 3; at < image.pixels.size(); at += 4) {
            open += image.pixels[at] < 128 ? 1 : 0;
        }
        const std::size_t count = image.pixels.size() / 4;
        EXPECT_GT(open, count / 10);
        EXPECT_LT(open, count * 7 / 10);
    }
}

TEST(Png, EncodesTheHeader) {
    const auto png = encodePng(paint(5, 3, 4, [](const glm::vec2& uv) { return glm::vec4(uv, 0.0F, 1.0F); }));
    ASSERT_TRUE(png.ok());
    const std::array<std::uint8_t, 8> signature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
    ASSERT_GT(png->size(), 33U);
    EXPECT_TRUE(std::equal(signature.begin(), signature.end(), png->begin()));
    EXPECT_EQ((*png)[19], 5);
    EXPECT_EQ((*png)[23], 3);
    EXPECT_EQ((*png)[25], 6);  // colour type: RGBA
}

TEST(Png, RefusesAnImageWithoutPixels) {
    EXPECT_EQ(mustFail(encodePng(Image{})).id, "png-encode");
}

}  // namespace gallery::test
