// Tests the distribution by which surfaces sample environment maps.
#include "interop/lights.h"
#include "sample_maps.h"
#include "sky/radiance_map.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <span>
#include <vector>

namespace glint::test {
namespace {

// Each list rises by at least 1 and ends with all counts.
void expectWhole(std::span<const std::uint32_t> sums) {
    std::uint32_t last = 0;
    for (const std::uint32_t sum : sums) {
        ASSERT_GT(sum, last);
        last = sum;
    }
    EXPECT_EQ(last, gpu::kSkyCounts);
}

void expectWhole(const SkyCounts& counts) {
    ASSERT_EQ(counts.counts.size(), std::size_t{counts.rows} * (1 + counts.columns));
    const std::span<const std::uint32_t> all(counts.counts);
    expectWhole(all.first(counts.rows));
    for (std::uint32_t row = 0; row < counts.rows; ++row) {
        expectWhole(all.subspan(counts.rows + std::size_t{row} * counts.columns, counts.columns));
    }
}

double chanceOf(const SkyCounts& counts, std::uint32_t row, std::uint32_t column) {
    const auto countAt = [&](std::size_t first, std::uint32_t cell) {
        return counts.counts[first + cell] - (cell == 0 ? 0 : counts.counts[first + cell - 1]);
    };
    const double whole = gpu::kSkyCounts;
    return countAt(0, row) / whole *
           (countAt(counts.rows + std::size_t{row} * counts.columns, column) / whole);
}

TEST(SkyCounts, HaveTheSizeOfTheMapUpToALimit) {
    const auto one = [](const Direction&) { return 1.0; };
    const SkyCounts small = skyCounts(grayMap(256, 128, one));
    EXPECT_EQ(small.columns, 256U);
    EXPECT_EQ(small.rows, 128U);
    const SkyCounts large = skyCounts(grayMap(2048, 1024, one));
    EXPECT_EQ(large.columns, kMostSkyColumns);
    EXPECT_EQ(large.rows, kMostSkyRows);
    expectWhole(small);
    expectWhole(large);
    for (std::uint32_t row = 0; row < small.rows; row += 9) {
        EXPECT_NEAR(chanceOf(small, row, 31) / texelSolidAngle(row, 256, 128) * 4.0 * kPi, 1.0, 2e-3);
    }
}

TEST(SkyCounts, FollowTheLuminance) {
    const auto bright = [](const Direction& d) { return 0.5 + std::max(d[0], 0.0) + 0.25 * d[1]; };
    const RadianceMap map = grayMap(256, 128, bright);
    const SkyCounts counts = skyCounts(map);
    expectWhole(counts);
    const double total = flux(map)[0];
    for (std::uint32_t row = 4; row < 124; row += 11) {
        for (std::uint32_t column = 3; column < 256; column += 17) {
            const double share =
                texelSolidAngle(row, 256, 128) *
                (bright(directionOf(column + 0.5, row + 0.5, map)) + 0.01 * total / (4.0 * kPi)) /
                (1.01 * total);
            EXPECT_NEAR(chanceOf(counts, row, column) / share, 1.0, 0.02) << row << ", " << column;
        }
    }
}

// However bright a sun is, it leaves a count to every other cell; and black maps are uniform.
TEST(SkyCounts, HoldForTheExtremes) {
    RadianceMap map = grayMap(256, 128, [](const Direction&) { return 1e-6; });
    map.texels[std::size_t{40} * 256 + 100] = {1e18F, 1e18F, 1e18F};
    const SkyCounts sun = skyCounts(map);
    expectWhole(sun);
    EXPECT_GT(chanceOf(sun, 40, 100), 0.5);
    EXPECT_GT(chanceOf(sun, 40, 99), 0.05) << "bilinear lookups see the sun there";
    const SkyCounts black = skyCounts(grayMap(256, 128, [](const Direction&) { return 0.0; }));
    expectWhole(black);
    EXPECT_NEAR(chanceOf(black, 64, 0), chanceOf(black, 64, 200), 1e-9);
    EXPECT_NEAR(chanceOf(black, 64, 0) / chanceOf(black, 10, 0),
                texelSolidAngle(64, 256, 128) / texelSolidAngle(10, 256, 128), 0.02);
}

}  // namespace
}  // namespace glint::test
