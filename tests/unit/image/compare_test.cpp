#include "image/compare.h"

#include "support/must.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace glint {
namespace {

LinearImage grey(std::uint32_t width, std::uint32_t height, float value) {
    LinearImage image{width, height, {}};
    image.pixels.assign(std::size_t{width} * height, {value, value, value, 1.0F});
    return image;
}

image::ImageDifference compared(const LinearImage& image, const LinearImage& reference) {
    Result<image::ImageDifference> difference = image::compareImages(image, reference, "a", "b");
    EXPECT_TRUE(difference);
    return difference.value();
}

TEST(Compare, EqualImagesHaveNoError) {
    const LinearImage image = grey(3, 2, 0.5F);
    const image::ImageDifference difference = compared(image, image);
    EXPECT_EQ(difference.absolute.value, 0.0);
    EXPECT_EQ(difference.relative.value, 0.0);
    EXPECT_EQ(difference.rmse, 0.0);
    EXPECT_EQ(difference.differing, 0U);
    EXPECT_EQ(difference.pixels, 6U);
    EXPECT_TRUE(std::isinf(difference.psnr));
}

TEST(Compare, OffsetGivesTheTextbookValues) {
    const image::ImageDifference difference = compared(grey(4, 4, 0.75F), grey(4, 4, 0.5F));
    EXPECT_DOUBLE_EQ(difference.mean, 0.25);
    EXPECT_DOUBLE_EQ(difference.rmse, 0.25);
    EXPECT_NEAR(difference.relMse, 0.0625 / 0.26, 1e-14);
    EXPECT_NEAR(difference.psnr, 20.0 * std::log10(4.0), 1e-12);
    EXPECT_EQ(difference.differing, 16U);
}

TEST(Compare, PeakOfPsnrFollowsABrightReference) {
    const image::ImageDifference difference = compared(grey(1, 1, 9.0F), grey(1, 1, 10.0F));
    EXPECT_NEAR(difference.psnr, 20.0, 1e-12);
}

TEST(Compare, FindsWhereTheLargestErrorsAre) {
    LinearImage image = grey(5, 4, 0.0F);
    LinearImage reference = grey(5, 4, 0.0F);
    image.pixels[7][1] = 0.5F;  // (2, 1), the largest relative error
    image.pixels[13][2] = 102.0F;
    reference.pixels[13][2] = 100.0F;  // (3, 2), the largest absolute error
    const image::ImageDifference difference = compared(image, reference);
    EXPECT_DOUBLE_EQ(difference.absolute.value, 2.0);
    EXPECT_EQ(difference.absolute.x, 3U);
    EXPECT_EQ(difference.absolute.y, 2U);
    EXPECT_EQ(difference.absolute.channel, 2);
    EXPECT_DOUBLE_EQ(difference.relative.value, 0.5);
    EXPECT_EQ(difference.relative.x, 2U);
    EXPECT_EQ(difference.relative.y, 1U);
    EXPECT_EQ(difference.relative.channel, 1);
    EXPECT_EQ(difference.differing, 2U);
}

TEST(Compare, CountsWhatIsNotFiniteAndLeavesItOut) {
    LinearImage image = grey(2, 2, 0.5F);
    LinearImage reference = grey(2, 2, 0.5F);
    image.pixels[0][0] = std::numeric_limits<float>::quiet_NaN();
    reference.pixels[1][2] = std::numeric_limits<float>::infinity();
    const image::ImageDifference difference = compared(image, reference);
    EXPECT_EQ(difference.nonFinite, 1U);
    EXPECT_EQ(difference.referenceNonFinite, 1U);
    EXPECT_EQ(difference.pixels, 2U);
    EXPECT_EQ(difference.rmse, 0.0);
}

TEST(Compare, AlphaIsNoError) {
    LinearImage image = grey(1, 1, 0.5F);
    image.pixels[0][3] = 0.0F;
    EXPECT_EQ(compared(image, grey(1, 1, 0.5F)).differing, 0U);
}

TEST(Compare, RefusesOtherSizes) {
    const Diagnostic difference =
        mustFail(image::compareImages(grey(2, 3, 0), grey(3, 2, 0), "a.png", "b.png"));
    EXPECT_EQ(difference.id, "image-mismatch");
    EXPECT_EQ(difference.where, "a.png");
    EXPECT_NE(difference.message.find("2 x 3"), std::string::npos);
    EXPECT_NE(difference.message.find("b.png is 3 x 2"), std::string::npos);
}

TEST(DifferenceMap, IsBlackWhereEqualBrighterWithErrorGreenWhereNotFinite) {
    LinearImage image = grey(5, 1, 0.0F);
    const LinearImage reference = grey(5, 1, 0.0F);
    image.pixels[1][0] = 0.001F;
    image.pixels[2][0] = 0.1F;
    image.pixels[3][0] = 5.0F;
    image.pixels[4][0] = std::numeric_limits<float>::quiet_NaN();
    const image::DisplayImage map = image::differenceMap(image, reference);
    const auto brightness = [&](std::size_t i) {
        return map.pixels[i][0] + map.pixels[i][1] + map.pixels[i][2];
    };
    EXPECT_EQ(brightness(0), 0);
    EXPECT_LT(brightness(1), brightness(2));
    EXPECT_LT(brightness(2), brightness(3));
    EXPECT_EQ(map.pixels[3], (std::array<std::uint8_t, 3>{252, 255, 164}));
    EXPECT_EQ(map.pixels[4], (std::array<std::uint8_t, 3>{0, 255, 0}));
}

}  // namespace
}  // namespace glint
