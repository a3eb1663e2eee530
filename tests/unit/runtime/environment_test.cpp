// Tests environment maps on the host: which are accepted, sizes, importance, diffuse light, 16-bit floats.
#include "sample_maps.h"
#include "sky/map_filter.h"
#include "sky/radiance_map.h"
#include "support/must.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace glint::test {
namespace {

LinearImage imageOf(std::uint32_t width, std::uint32_t height) {
    LinearImage image{width, height, {}};
    image.pixels.assign(std::size_t{width} * height, {1.0F, 2.0F, 3.0F, 1.0F});
    return image;
}

TEST(MapCheck, SaysWhichPixelIsWrong) {
    LinearImage image = imageOf(5, 3);
    image.pixels[2 * 5 + 4][1] = std::numeric_limits<float>::quiet_NaN();
    const Diagnostic nan = mustFail(checkMap(image));
    EXPECT_EQ(nan.id, "environment-radiance");
    EXPECT_NE(nan.message.find("column 4, row 2"), std::string::npos) << nan.message;
    EXPECT_NE(nan.message.find("NaN"), std::string::npos) << nan.message;
    image.pixels[2 * 5 + 4][1] = std::numeric_limits<float>::infinity();
    EXPECT_NE(checkMap(image).error().message.find("infinite"), std::string::npos);
    image.pixels[2 * 5 + 4][1] = 2e18F;
    EXPECT_NE(checkMap(image).error().message.find("brighter"), std::string::npos);
}

TEST(MapCheck, TakesNegativeRadianceAsNone) {
    LinearImage image = imageOf(4, 2);
    image.pixels[3] = {-1.0F, 2.0F, -3.0F, 1.0F};
    image.pixels[6][2] = -0.5F;
    const CheckedMap checked = must(checkMap(image));
    EXPECT_EQ(checked.negativePixels, 2U);
    EXPECT_EQ(checked.map.texels[3], (Radiance{0.0F, 2.0F, 0.0F}));
}

TEST(MapCheck, WantsEveryPixel) {
    EXPECT_EQ(checkMap({}).error().id, "environment-size");
    LinearImage image = imageOf(4, 2);
    image.pixels.pop_back();
    EXPECT_EQ(checkMap(image).error().id, "environment-size");
}

TEST(MapSize, SolidAnglesAddUpToTheSphere) {
    double sum = 0.0;
    for (std::uint32_t row = 0; row < 37; ++row) {
        sum += 11 * texelSolidAngle(row, 11, 37);
    }
    EXPECT_NEAR(sum, 4.0 * kPi, 1e-12);
}

TEST(MapSize, ResamplingKeepsTheLight) {
    const RadianceMap map = sunMap(150, 70);
    const std::array<double, 3> before = flux(map);
    for (const auto& [width, height] : {std::pair{75U, 35U}, {64U, 64U}, {301U, 141U}, {1U, 1U}}) {
        const std::array<double, 3> after = flux(resample(map, width, height));
        for (std::size_t channel = 0; channel < 3; ++channel) {
            EXPECT_NEAR(after[channel] / before[channel], 1.0, 1e-5) << width << " x " << height;
        }
    }
}

TEST(MapSize, FitsTheDevice) {
    const auto sizeOf = [](std::uint32_t width, std::uint32_t height) {
        const RadianceMap map = fitToDevice(grayMap(width, height, [](const Direction&) { return 0.5; }));
        for (const Radiance& radiance : map.texels) {
            EXPECT_NEAR(radiance[0], 0.5F, 1e-6F);
        }
        return std::pair(map.width, map.height);
    };
    EXPECT_EQ(sizeOf(1, 1), std::pair(256U, 128U));
    EXPECT_EQ(sizeOf(300, 150), std::pair(300U, 150U));
    EXPECT_EQ(sizeOf(3000, 1500), std::pair(2048U, 1024U));
    EXPECT_EQ(levelCount(256), 4U);
    EXPECT_EQ(levelCount(1024), 6U);
    EXPECT_EQ(levelCount(1500), 6U);
    EXPECT_EQ(levelCount(2048), 7U);
}

TEST(MapImportance, DensitiesIntegrateToOne) {
    const RadianceMap map = sunMap(64, 32);
    const MapDistribution distribution(map);
    double sum = 0.0;
    for (std::size_t i = 0; i < map.texels.size(); ++i) {
        sum += distribution.pdf(i) * texelSolidAngle(static_cast<std::uint32_t>(i / 64), 64, 32);
    }
    EXPECT_NEAR(sum, 1.0, 1e-6);
}

// Luminance over density equals the sum over texels for every sample, and the sample is where it says.
TEST(MapImportance, EverySampleGivesTheIntegral) {
    const RadianceMap map = sunMap(64, 32);
    const MapDistribution distribution(map);
    const std::array<double, 3> total = flux(map);
    const double expected = 0.2126 * total[0] + 0.7152 * total[1] + 0.0722 * total[2];
    std::mt19937 random(1);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (int i = 0; i < 10000; ++i) {
        const MapSample sample = distribution.sample(unit(random), unit(random));
        EXPECT_NEAR(luminance(map.texels[sample.texel]) / sample.pdf / expected, 1.0, 1e-5);
        const double v = std::acos(sample.direction[1]) / kPi * map.height;
        const double u =
            (std::atan2(sample.direction[2], sample.direction[0]) / (2.0 * kPi) + 0.5) * map.width;
        const std::size_t row = sample.texel / 64;
        const std::size_t column = sample.texel % 64;
        EXPECT_NEAR(v, static_cast<double>(row) + 0.5, 0.5 + 1e-6);
        EXPECT_NEAR(u, static_cast<double>(column) + 0.5, 0.5 + 1e-6);
        EXPECT_NEAR(dot(sample.direction, sample.direction), 1.0, 1e-12);
    }
}

// Pearson's statistic over all texels; its standard deviation is √(2n).
TEST(MapImportance, SamplesFollowTheDensity) {
    constexpr std::uint32_t kWidth = 16;
    constexpr std::uint32_t kHeight = 8;
    const RadianceMap map =
        grayMap(kWidth, kHeight, [](const Direction& d) { return 1.2 + d[0] * d[1] + 0.7 * d[2]; });
    const MapDistribution distribution(map);
    constexpr int kSamples = 200000;
    std::vector<int> counts(map.texels.size());
    std::mt19937 random(2);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (int i = 0; i < kSamples; ++i) {
        counts[distribution.sample(unit(random), unit(random)).texel] += 1;
    }
    double statistic = 0.0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        const double expected = kSamples * distribution.pdf(i) *
                                texelSolidAngle(static_cast<std::uint32_t>(i / kWidth), kWidth, kHeight);
        statistic += (counts[i] - expected) * (counts[i] - expected) / expected;
    }
    const double n = kWidth * kHeight - 1;
    EXPECT_LT(statistic, n + 5.0 * std::sqrt(2.0 * n));
}

TEST(MapImportance, NeverSamplesBlackUnlessAllIs) {
    RadianceMap map = grayMap(8, 4, [](const Direction&) { return 0.0; });
    const MapDistribution black(map);
    EXPECT_NEAR(black.pdf(13), 1.0 / (4.0 * kPi), 1e-6);
    map.texels[9] = {0.0F, 1.0F, 0.0F};
    map.texels[22] = {0.0F, 3.0F, 0.0F};
    const MapDistribution distribution(map);
    for (const double row : {0.0, 0.2, 0.5, 0.9, 1.0 - 1e-16}) {
        for (const double column : {0.0, 0.3, 1.0 - 1e-16}) {
            const std::size_t texel = distribution.sample(row, column).texel;
            EXPECT_TRUE(texel == 9 || texel == 22) << texel;
        }
    }
}

double evaluate(const SkyHarmonics& h, const Direction& n) {
    const auto& [x, y, z] = n;
    const double basis[9] = {1.0, x, y, z, 3.0 * y * y - 1.0, x * y, y * z, x * z, x * x - z * z};
    double sum = 0.0;
    for (std::size_t i = 0; i < 9; ++i) {
        sum += basis[i] * h[i][0];
    }
    return sum;
}

TEST(Harmonics, AConstantSkyHasNoDirection) {
    const SkyHarmonics h = skyHarmonics(grayMap(17, 9, [](const Direction&) { return 0.75; }));
    EXPECT_NEAR(h[0][0], 0.75, 1e-12);
    for (std::size_t i = 1; i < 9; ++i) {
        EXPECT_NEAR(h[i][2], 0.0, 1e-12) << i;
    }
}

// The cosine lobe, over π, multiplies the orders 0, 1 and 2 by 1, 2/3 and 1/4.
TEST(Harmonics, OrdersShrinkByTheCosineLobe) {
    const auto sky = [](const Direction& d) { return 3.0 + d[0] + 0.5 * d[1] - 0.25 * d[2]; };
    const auto second = [](const Direction& d) {
        const auto& [x, y, z] = d;
        return 0.3 * x * y - 0.2 * y * z + 0.4 * x * z + 0.1 * (x * x - z * z) + 0.15 * (3.0 * y * y - 1.0);
    };
    const SkyHarmonics h =
        skyHarmonics(grayMap(512, 256, [&](const Direction& d) { return sky(d) + second(d); }));
    for (const Direction& n :
         {Direction{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.6, 0, -0.8}, {0.48, -0.6, 0.64}}) {
        EXPECT_NEAR(evaluate(h, n), 3.0 + (sky(n) - 3.0) * 2.0 / 3.0 + second(n) / 4.0, 1e-4);
    }
}

TEST(Harmonics, TurnWithTheMap) {
    const RadianceMap map = grayMap(
        64, 32, [](const Direction& d) { return std::max(0.0, 0.6 * d[0] + 0.48 * d[1] + 0.64 * d[2]); });
    // The content at u moves to u - 5/64: counter-clockwise from above, as u runs clockwise.
    RadianceMap shifted = map;
    for (std::size_t i = 0; i < map.texels.size(); ++i) {
        shifted.texels[i] = map.texels[i / 64 * 64 + (i + 5) % 64];
    }
    const SkyHarmonics expected = skyHarmonics(shifted);
    const SkyHarmonics actual = turned(skyHarmonics(map), 2.0 * kPi * 5.0 / 64.0);
    for (std::size_t i = 0; i < 9; ++i) {
        EXPECT_NEAR(actual[i][1], expected[i][1], 1e-9) << i;
    }
}

TEST(HalfFloat, EveryValueComesBack) {
    for (std::uint32_t bits = 0; bits <= 0x7BFFU; ++bits) {
        const auto exponent = static_cast<int>(bits >> 10U);
        const auto mantissa = static_cast<double>(bits & 0x3FFU);
        const double value =
            exponent == 0 ? std::ldexp(mantissa, -24) : std::ldexp(1024.0 + mantissa, exponent - 25);
        ASSERT_EQ(toHalf(static_cast<float>(value)), bits);
    }
    EXPECT_EQ(toHalf(kMaxHalf), 0x7BFF);
}

TEST(HalfFloat, RoundsToTheNearestAndTiesToEven) {
    EXPECT_EQ(toHalf(1.0F + 0x1p-11F), 0x3C00);
    EXPECT_EQ(toHalf(1.0F + 0x1.8p-10F), 0x3C02);
    EXPECT_EQ(toHalf(1.0F + 0x1.01p-11F), 0x3C01);
    EXPECT_EQ(toHalf(2.0F - 0x1p-11F), 0x4000);
    EXPECT_EQ(toHalf(0x1.8p-24F), 2);
    EXPECT_EQ(toHalf(0x1p-25F), 0);
    EXPECT_EQ(toHalf(0x1p-14F - 0x1p-26F), 0x0400);
}

}  // namespace
}  // namespace glint::test
