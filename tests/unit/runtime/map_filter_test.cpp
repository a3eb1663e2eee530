// Tests what rough surfaces see of an environment map.
#include "sky/map_filter.h"

#include "sample_maps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace glint::test {
namespace {

// Returns D(h) (n·l) of the GGX lobe about a direction, up to a factor, with the textbook's half vector.
double lobeWeight(double cosine, double roughness) {
    if (cosine <= 0.0) {
        return 0.0;
    }
    const double a2 = std::pow(roughness, 4.0);
    const double half = std::cos(std::acos(std::min(cosine, 1.0)) / 2.0);
    const double q = half * half * (a2 - 1.0) + 1.0;
    return a2 / (q * q) * cosine;
}

// Returns the mean by the sum over every texel of the map.
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

// A lobe spreads light without making or losing any. A texel sees at most the sun's solid angle times the
// peak of the lobe.
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
        // Some texel looks nearly at the sun.
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

}  // namespace
}  // namespace glint::test
