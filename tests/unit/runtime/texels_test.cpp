// Conversions of 16-bit texels, and records of materials.
#include "data/materials.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <vector>

namespace glint {
namespace {

std::vector<std::uint8_t> bytesOf(const std::vector<std::uint16_t>& channels) {
    std::vector<std::uint8_t> bytes(2 * channels.size());
    std::memcpy(bytes.data(), channels.data(), bytes.size());
    return bytes;
}

std::vector<std::uint16_t> channelsOf(const std::vector<std::uint8_t>& bytes) {
    std::vector<std::uint16_t> channels(bytes.size() / 2);
    std::memcpy(channels.data(), bytes.data(), bytes.size());
    return channels;
}

TEST(TexelsTest, LinearizesColourAndLeavesAlpha) {
    const std::vector<std::uint16_t> channels =
        channelsOf(linearizeRgba16(bytesOf({0, 65535, 32768, 32768, 2570, 13107, 257, 1})));
    // IEC 61966-2-1 by hand: 0.5 gives 0.21404, 0.2 gives 0.033105; below 0.04045 it divides by 12.92.
    EXPECT_EQ(channels[0], 0);
    EXPECT_EQ(channels[1], 65535);
    EXPECT_NEAR(channels[2] / 65535.0, 0.21404, 2e-5);
    EXPECT_EQ(channels[3], 32768);
    EXPECT_EQ(channels[4], std::lround(2570 / 12.92));
    EXPECT_NEAR(channels[5] / 65535.0, 0.033105, 1e-5);
    EXPECT_EQ(channels[6], std::lround(257 / 12.92));
    EXPECT_EQ(channels[7], 1);
}

// Each of the 256 values of 8-bit sRGB stays distinct from its neighbours, and converts back to itself.
TEST(TexelsTest, LinearKeepsEveryStepOfEightBits) {
    std::vector<std::uint16_t> encoded;
    for (std::uint32_t value = 0; value < 256; ++value) {
        encoded.insert(encoded.end(), 4, static_cast<std::uint16_t>(value * 257));
    }
    const std::vector<std::uint16_t> linear = channelsOf(linearizeRgba16(bytesOf(encoded)));
    for (std::uint32_t value = 0; value < 256; ++value) {
        const double light = linear[std::size_t{4} * value] / 65535.0;
        const double back = light <= 0.0031308 ? light * 12.92 : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
        EXPECT_EQ(std::lround(back * 255), static_cast<long>(value));
    }
}

TEST(TexelsTest, NarrowsToTheNearest) {
    const std::vector<std::uint8_t> narrow =
        narrowRgba16(bytesOf({0, 65535, 257, 128, 129, 385, 386, 65406}));
    EXPECT_EQ(narrow, (std::vector<std::uint8_t>{0, 255, 1, 0, 1, 1, 2, 254}));
    for (std::uint32_t value = 0; value < 65536; ++value) {
        const std::vector<std::uint16_t> channel{static_cast<std::uint16_t>(value)};
        ASSERT_EQ(narrowRgba16(bytesOf(channel))[0], std::lround(value / 65535.0 * 255)) << value;
    }
}

// An enum of other names, or a float in place of a whole number, has other bits for the same value.
TEST(RecordFields, TakeOverValuesOfTheSameNameAndType) {
    const RecordFields before{{{"bands", 0, 4, 0, 1}, {"edge", 4, 4, 0, 2}, {"step", 8, 4, 0, 3}}, {}};
    const RecordFields after{{{"edge", 0, 4, 0, 9}, {"bands", 4, 4, 0, 1}, {"step", 8, 4, 0, 3}}, {}};
    const std::vector<std::uint8_t> values{1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};
    std::vector<std::uint8_t> record(12);
    carryFields(before, 0, values, after, 0, record);
    EXPECT_EQ(record, (std::vector<std::uint8_t>{0, 0, 0, 0, 1, 1, 1, 1, 3, 3, 3, 3}));
}

}  // namespace
}  // namespace glint
