#include "image/tone.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace glint {
namespace {

TEST(Tone, SrgbIsItsOwnInverse) {
    for (int i = 0; i <= 255; ++i) {
        const float encoded = static_cast<float>(i) / 255.0F;
        EXPECT_NEAR(image::linearToSrgb(image::srgbToLinear(encoded)), encoded, 1e-6F) << i;
    }
    // IEC 61966-2-1: half of the code range is about 21 % of the light.
    EXPECT_NEAR(image::srgbToLinear(0.5F), 0.21404F, 1e-5F);
}

// The values were computed by hand from the specification's formulas.
TEST(Tone, NeutralMatchesTheSpecification) {
    // In the dark, x - x² / 0.16 is subtracted, so grey 0.04 becomes 0.01.
    EXPECT_NEAR(image::toneMapNeutral({0.04F, 0.04F, 0.04F})[0], 0.01F, 1e-6F);
    // In between, 0.04 is subtracted.
    const image::Rgb middle = image::toneMapNeutral({0.5F, 0.3F, 0.2F});
    EXPECT_NEAR(middle[0], 0.46F, 1e-6F);
    EXPECT_NEAR(middle[1], 0.26F, 1e-6F);
    EXPECT_NEAR(middle[2], 0.16F, 1e-6F);
    // Above, grey 1.04 has p = 1, and 1 - 0.24² / (1 + 1 - 1.52) = 0.88.
    EXPECT_NEAR(image::toneMapNeutral({1.04F, 1.04F, 1.04F})[1], 0.88F, 1e-6F);
}

TEST(Tone, NeutralStaysInRangeAndIsMonotonic) {
    float previous = -1.0F;
    float value = 0.0F;
    // The loop goes up to about a million.
    for (int step = 0; step < 195; ++step) {
        const image::Rgb mapped = image::toneMapNeutral({value, value * 0.5F, value * 0.1F});
        for (const float channel : mapped) {
            EXPECT_GE(channel, 0.0F);
            EXPECT_LE(channel, 1.0F);
        }
        EXPECT_GE(mapped[0], previous);
        previous = mapped[0];
        value = value * 1.1F + 1e-3F;
    }
    EXPECT_GT(value, 1e6F);
}

TEST(Tone, ExposureBringsGreyToTheKey) {
    LinearImage image{2, 2, {}};
    image.pixels.assign(4, {0.72F, 0.72F, 0.72F, 1.0F});
    EXPECT_NEAR(image::automaticExposure(image), -2.0, 1e-6);
    // Black, NaN and infinite pixels are not lit.
    image.pixels[1] = {0.0F, 0.0F, 0.0F, 1.0F};
    image.pixels[2] = {std::numeric_limits<float>::quiet_NaN(), 1.0F, 1.0F, 1.0F};
    image.pixels[3] = {std::numeric_limits<float>::infinity(), 1.0F, 1.0F, 1.0F};
    EXPECT_NEAR(image::automaticExposure(image), -2.0, 1e-6);
}

TEST(Tone, ExposureOfBlackIsZeroAndOfExtremesIsClamped) {
    LinearImage image{1, 1, {{0.0F, 0.0F, 0.0F, 1.0F}}};
    EXPECT_EQ(image::automaticExposure(image), 0.0);
    image.pixels[0] = {1e30F, 1e30F, 1e30F, 1.0F};
    EXPECT_EQ(image::automaticExposure(image), -32.0);
    image.pixels[0] = {1e-20F, 1e-20F, 1e-20F, 1.0F};
    EXPECT_EQ(image::automaticExposure(image), 32.0);
    // A white wall in sunlight of 100,000 lux.
    image.pixels[0] = {31831.0F, 31831.0F, 31831.0F, 1.0F};
    EXPECT_NEAR(image::automaticExposure(image), std::log2(0.18 / 31831.0), 1e-5);
}

TEST(Tone, ExposureLooksAtSurfaces) {
    LinearImage image{2, 2, {}};
    image.pixels.assign(4, {100.0F, 100.0F, 100.0F, 1.0F});
    image.pixels[2] = {0.72F, 0.72F, 0.72F, 1.0F};
    const std::vector<std::uint8_t> surfaces{0, 0, 1, 0};
    EXPECT_NEAR(image::automaticExposure(image, surfaces), -2.0, 1e-6);
    // Where nothing is a surface, the sky is what there is to see.
    const std::vector<std::uint8_t> none(4, 0);
    EXPECT_EQ(image::automaticExposure(image, none), image::automaticExposure(image));
}

// What is nearly black, next to the others, is not looked at, whatever the units.
TEST(Tone, ExposureIgnoresWhatIsNearlyBlack) {
    for (const float unit : {1e-6F, 1.0F, 1e6F}) {
        LinearImage image{3, 1, {}};
        const float grey = 0.72F * unit;
        image.pixels.assign(3, {grey, grey, grey, 1.0F});
        const double expected = image::automaticExposure(image);
        image.pixels[1] = {1e-8F * grey, 1e-8F * grey, 1e-8F * grey, 1.0F};
        EXPECT_NEAR(image::automaticExposure(image), expected, 1e-6) << unit;
        EXPECT_NEAR(expected, -2.0 - std::log2(unit), 1e-5) << unit;
    }
}

TEST(Tone, DisplayShowsWhatIsNotFinite) {
    const std::array<std::uint8_t, 3> magenta{255, 0, 255};
    EXPECT_EQ(image::toDisplay({std::numeric_limits<float>::quiet_NaN(), 0.0F, 0.0F}, 0.0), magenta);
    EXPECT_EQ(image::toDisplay({0.0F, std::numeric_limits<float>::infinity(), 0.0F}, 0.0), magenta);
    const std::array<std::uint8_t, 3> black{0, 0, 0};
    EXPECT_EQ(image::toDisplay({-1.0F, 0.0F, 0.0F}, 0.0), black);
    // A huge colour and exposure together stay finite.
    EXPECT_GE(image::toDisplay({1e38F, 1e38F, 1e38F}, 100.0)[0], 254);
}

// FLIP looks at the pixels of a PNG before they are rounded to 8 bits.
TEST(Tone, DisplayedImageIsWhatIsWrittenUnrounded) {
    const LinearImage image{4,
                            1,
                            {{0.2F, 0.1F, 0.3F, 0.5F},
                             {7.0F, 0.0F, -1.0F, 1.0F},
                             {1e30F, 1.0F, 1.0F, 1.0F},
                             {std::numeric_limits<float>::quiet_NaN(), 0.0F, 0.0F, 1.0F}}};
    const LinearImage shown = image::displayedImage(image, 1.5);
    ASSERT_EQ(shown.pixels.size(), 4U);
    for (std::size_t i = 0; i < 4; ++i) {
        const std::array<float, 4>& pixel = shown.pixels[i];
        const std::array<std::uint8_t, 3> display =
            image::toDisplay({image.pixels[i][0], image.pixels[i][1], image.pixels[i][2]}, 1.5);
        for (std::size_t c = 0; c < 3; ++c) {
            EXPECT_GE(pixel[c], 0.0F);
            EXPECT_LE(pixel[c], 1.0F);
            EXPECT_NEAR(image::linearToSrgb(pixel[c]) * 255.0F, static_cast<float>(display[c]), 0.5001F);
        }
        EXPECT_EQ(pixel[3], image.pixels[i][3]);
    }
}

TEST(Tone, DisplayDoublesWithEveryStop) {
    EXPECT_EQ(image::toDisplay({0.2F, 0.1F, 0.3F}, 1.0), image::toDisplay({0.4F, 0.2F, 0.6F}, 0.0));
}

}  // namespace
}  // namespace glint
