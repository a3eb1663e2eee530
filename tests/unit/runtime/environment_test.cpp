// What the runtime makes of an environment map on the host.
#include "half_float.h"
#include "map_distribution.h"
#include "map_filter.h"
#include "radiance_map.h"
#include "sky_harmonics.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>

namespace glint {
namespace {

constexpr double kPi = std::numbers::pi;

Direction directionOf(double column, double row, const RadianceMap& map) {
    const double polar = kPi * row / map.height;
    const double azimuth = 2.0 * kPi * (column / map.width - 0.5);
    return {std::sin(polar) * std::cos(azimuth), std::cos(polar), std::sin(polar) * std::sin(azimuth)};
}

RadianceMap makeMap(std::uint32_t width, std::uint32_t height,
                    const std::function<Radiance(const Direction&)>& radiance) {
    RadianceMap map{width, height, {}};
    for (std::uint32_t row = 0; row < height; ++row) {
        for (std::uint32_t column = 0; column < width; ++column) {
            map.texels.push_back(radiance(directionOf(column + 0.5, row + 0.5, map)));
        }
    }
    return map;
}

RadianceMap grayMap(std::uint32_t width, std::uint32_t height,
                    const std::function<double(const Direction&)>& value) {
    return makeMap(width, height, [&](const Direction& d) {
        const auto v = static_cast<float>(value(d));
        return Radiance{v, v, v};
    });
}

// Sky of 1, and a sun of 2 x 2 texels with 1e5.
RadianceMap sunMap(std::uint32_t width, std::uint32_t height) {
    RadianceMap map = grayMap(width, height, [](const Direction&) { return 1.0; });
    for (const std::uint32_t row : {height / 4, height / 4 + 1}) {
        for (const std::uint32_t column : {width / 3, width / 3 + 1}) {
            map.texels[std::size_t{row} * width + column] = {1e5F, 8e4F, 5e4F};
        }
    }
    return map;
}

std::array<double, 3> flux(const RadianceMap& map) {
    std::array<double, 3> sum{};
    for (std::size_t i = 0; i < map.texels.size(); ++i) {
        const double solidAngle =
            texelSolidAngle(static_cast<std::uint32_t>(i / map.width), map.width, map.height);
        for (std::size_t channel = 0; channel < 3; ++channel) {
            sum[channel] += solidAngle * map.texels[i][channel];
        }
    }
    return sum;
}

double dot(const Direction& a, const Direction& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// D(h) (n·l) of the GGX lobe about a direction, up to a factor, by the textbook's half vector.
double lobeWeight(double cosine, double roughness) {
    if (cosine <= 0.0) {
        return 0.0;
    }
    const double a2 = std::pow(roughness, 4.0);
    const double half = std::cos(std::acos(std::min(cosine, 1.0)) / 2.0);
    const double q = half * half * (a2 - 1.0) + 1.0;
    return a2 / (q * q) * cosine;
}

// By the sum over every texel of the map.
Radiance lobeMean(const RadianceMap& map, const Direction& n, double roughness) {
    std::array<double, 3> sum{};
    double total = 0.0;
    for (std::uint32_t row = 0; row < map.height; ++row) {
        const double solidAngle = texelSolidAngle(row, map.width, map.height);
        for (std::uint32_t column = 0; column < map.width; ++column) {
            const double weight =
                lobeWeight(dot(n, directionOf(column + 0.5, row + 0.5, map)), roughness) * solidAngle;
            const Radiance& radiance = map.texels[std::size_t{row} * map.width + column];
            for (std::size_t channel = 0; channel < 3; ++channel) {
                sum[channel] += weight * radiance[channel];
            }
            total += weight;
        }
    }
    return {static_cast<float>(sum[0] / total), static_cast<float>(sum[1] / total),
            static_cast<float>(sum[2] / total)};
}

LinearImage imageOf(std::uint32_t width, std::uint32_t height) {
    LinearImage image{width, height, {}};
    image.pixels.assign(std::size_t{width} * height, {1.0F, 2.0F, 3.0F, 1.0F});
    return image;
}

TEST(MapCheck, SaysWhichPixelIsWrong) {
    LinearImage image = imageOf(5, 3);
    image.pixels[2 * 5 + 4][1] = std::numeric_limits<float>::quiet_NaN();
    const Result<CheckedMap> nan = checkMap(image);
    ASSERT_FALSE(nan);
    EXPECT_EQ(nan.error().id, "environment-radiance");
    EXPECT_NE(nan.error().message.find("column 4, row 2"), std::string::npos) << nan.error().message;
    EXPECT_NE(nan.error().message.find("NaN"), std::string::npos) << nan.error().message;
    image.pixels[2 * 5 + 4][1] = std::numeric_limits<float>::infinity();
    EXPECT_NE(checkMap(image).error().message.find("infinite"), std::string::npos);
    image.pixels[2 * 5 + 4][1] = 2e18F;
    EXPECT_NE(checkMap(image).error().message.find("brighter"), std::string::npos);
}

TEST(MapCheck, TakesNegativeRadianceAsNone) {
    LinearImage image = imageOf(4, 2);
    image.pixels[3] = {-1.0F, 2.0F, -3.0F, 1.0F};
    image.pixels[6][2] = -0.5F;
    const Result<CheckedMap> checked = checkMap(image);
    ASSERT_TRUE(checked);
    EXPECT_EQ(checked->negativePixels, 2U);
    EXPECT_EQ(checked->map.texels[3], (Radiance{0.0F, 2.0F, 0.0F}));
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

// Luminance over density is what the sum over texels is, whatever the sample; and the sample is where it
// says.
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
        EXPECT_NEAR(v, static_cast<double>(sample.texel / 64) + 0.5, 0.5 + 1e-6);
        EXPECT_NEAR(u, static_cast<double>(sample.texel % 64) + 0.5, 0.5 + 1e-6);
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

// The cosine lobe, over π, leaves 1, 2/3 and 1/4 of the orders 0, 1 and 2.
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
    // What is at u comes to u - 5/64: counter-clockwise from above, as u runs clockwise.
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

TEST(Filter, AConstantMapStaysSo) {
    const std::vector<RadianceMap> levels = filterByRoughness(makeMap(256, 128, [](const Direction&) {
        return Radiance{0.25F, 4.0F, 1e4F};
    }));
    ASSERT_EQ(levels.size(), 4U);
    for (std::size_t level = 0; level < levels.size(); ++level) {
        EXPECT_EQ(levels[level].width, 256U >> level);
        EXPECT_EQ(levels[level].height, 128U >> level);
        for (const Radiance& radiance : levels[level].texels) {
            EXPECT_NEAR(radiance[0], 0.25F, 1e-6F);
            EXPECT_NEAR(radiance[1], 4.0F, 1e-5F);
            EXPECT_NEAR(radiance[2], 1e4F, 0.05F);
        }
    }
}

// A lobe spreads light and neither makes nor loses it; and a texel sees of the sun what its solid angle times
// the peak of the lobe allows.
TEST(Filter, ASunKeepsItsLight) {
    const RadianceMap map = sunMap(512, 256);
    const std::array<double, 3> before = flux(map);
    const double sun = before[0] - 4.0 * kPi;
    const std::vector<RadianceMap> levels = filterByRoughness(map);
    ASSERT_EQ(levels.size(), 5U);
    EXPECT_EQ(levels[0].texels, map.texels);
    for (std::size_t level = 1; level < levels.size(); ++level) {
        const std::array<double, 3> after = flux(levels[level]);
        for (std::size_t channel = 0; channel < 3; ++channel) {
            EXPECT_NEAR(after[channel] / before[channel], 1.0, 0.01) << level;
        }
        const double roughness = static_cast<double>(level) / 4.0;
        double lobe = 0.0;
        constexpr int kSteps = 100000;
        for (int i = 0; i < kSteps; ++i) {
            lobe += lobeWeight((i + 0.5) / kSteps, roughness) * 2.0 * kPi / kSteps;
        }
        const double most = 1.0 + sun * lobeWeight(1.0, roughness) / lobe;
        float brightest = 0.0F;
        for (const Radiance& radiance : levels[level].texels) {
            brightest = std::max(brightest, radiance[0]);
            EXPECT_GE(radiance[0], 0.99F);
        }
        EXPECT_LE(brightest, most * 1.02) << level;
        // And a texel looks nearly at it.
        EXPECT_GE(brightest, most * 0.5) << level;
    }
}

TEST(Filter, EqualsTheSumOverAllTexels) {
    RadianceMap map = makeMap(256, 128, [](const Direction& d) {
        const auto tint = [&](double k) {
            return static_cast<float>(1.0 + 0.8 * std::sin(k * d[0]) * std::cos(3.0 * d[1] + d[2]));
        };
        return d[1] < -0.2 ? Radiance{0.1F, 0.2F, 0.3F} : Radiance{tint(3.0), tint(4.0), tint(5.0)};
    });
    for (const std::size_t texel : {std::size_t{30} * 256, std::size_t{30} * 256 + 255}) {
        map.texels[texel] = {2e3F, 1e3F, 5e2F};  // on both sides of the seam
    }
    const std::vector<RadianceMap> levels = filterByRoughness(map);
    for (std::size_t level = 1; level < levels.size(); ++level) {
        const RadianceMap& filtered = levels[level];
        for (const double row : {0.0, 0.1, 0.24, 0.5, 0.6, 0.99}) {
            for (const double column : {0.0, 0.3, 0.6, 0.999}) {
                const auto x = static_cast<std::uint32_t>(column * filtered.width);
                const auto y = static_cast<std::uint32_t>(row * filtered.height);
                const Radiance& actual = filtered.texels[std::size_t{y} * filtered.width + x];
                const Radiance expected =
                    lobeMean(map, directionOf(x + 0.5, y + 0.5, filtered), static_cast<double>(level) / 3.0);
                for (std::size_t channel = 0; channel < 3; ++channel) {
                    EXPECT_NEAR(actual[channel] / expected[channel], 1.0F, 0.03F)
                        << "level " << level << ", column " << x << ", row " << y;
                }
            }
        }
    }
}

TEST(Filter, IsTheSameEveryTime) {
    const RadianceMap map = sunMap(256, 128);
    const std::vector<RadianceMap> once = filterByRoughness(map);
    const std::vector<RadianceMap> again = filterByRoughness(map);
    for (std::size_t level = 0; level < once.size(); ++level) {
        EXPECT_EQ(once[level].texels, again[level].texels) << level;
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
}  // namespace glint
