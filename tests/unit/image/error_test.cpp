#include "image/compare.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace glint {
namespace {

LinearImage constant(float value, std::uint32_t width = 40, std::uint32_t height = 25) {
    LinearImage image{width, height, {}};
    image.pixels.assign(std::size_t{width} * height, {value, value, value, 1.0F});
    return image;
}

TEST(ImageErrors, AreNothingForTheReferenceItself) {
    const image::ImageErrors errors = image::measureErrors(constant(0.5F), constant(0.5F), 1.0);
    EXPECT_EQ(errors.relMse, 0.0);
    EXPECT_EQ(errors.rmse, 0.0);
    EXPECT_EQ(errors.p999, 0.0);
    EXPECT_EQ(errors.trimmed, 0.0);
    EXPECT_EQ(errors.bias, 0.0);
    EXPECT_EQ(errors.flip, 0.0);
    EXPECT_TRUE(std::isinf(errors.psnr));
}

TEST(ImageErrors, AreThoseOfTheirFormulas) {
    // Exposed by two stops, this compares 0.4 with 0.8.
    const image::ImageErrors errors = image::measureErrors(constant(0.1F), constant(0.2F), 2.0);
    EXPECT_NEAR(errors.rmse, 0.4, 1e-6);
    EXPECT_NEAR(errors.relMse, 0.16 / (0.64 + 0.01), 1e-6);
    EXPECT_NEAR(errors.trimmed, errors.relMse, 1e-9);
    EXPECT_NEAR(errors.p999, std::sqrt(errors.relMse), 1e-6);
    EXPECT_NEAR(errors.psnr, -20.0 * std::log10(0.4), 1e-5);
    EXPECT_NEAR(errors.bias, -0.5, 1e-6);
    EXPECT_GT(errors.flip, 0.0);
}

TEST(ImageErrors, OfInliersLeaveOutTheWorstPixels) {
    const LinearImage reference = constant(0.5F);
    LinearImage image = reference;
    image.pixels[7] = {1000.0F, 1000.0F, 1000.0F, 1.0F};  // one of 1000
    const image::ImageErrors errors = image::measureErrors(image, reference, 0.0);
    EXPECT_GT(errors.relMse, 1000.0);
    EXPECT_EQ(errors.trimmed, 0.0);
    EXPECT_EQ(errors.p999, 0.0);
    image.pixels[8] = image.pixels[7];
    EXPECT_GT(image::measureErrors(image, reference, 0.0).p999, 100.0);
}

TEST(MeanImage, SaysHowCertainItIs) {
    std::mt19937_64 random(3);
    std::normal_distribution<float> noise(2.0F, 0.5F);
    image::MeanImage sum(100, 100);
    constexpr int kBlocks = 16;
    for (int block = 0; block < kBlocks; ++block) {
        LinearImage image{100, 100, {}};
        for (int i = 0; i < 100 * 100; ++i) {
            image.pixels.push_back({noise(random), noise(random), noise(random), 1.0F});
        }
        sum.add(image);
    }
    const LinearImage error = sum.standardError();
    double squares = 0.0;
    for (const auto& pixel : error.pixels) {
        squares += double{pixel[0]} * pixel[0];
    }
    EXPECT_NEAR(squares / 1e4, 0.25 / kBlocks, 0.03 * 0.25 / kBlocks);
    // The stated errors must match those that the mean really has.
    const image::ImageErrors stated = image::noiseOf(sum.mean(), error, 0.0);
    const image::ImageErrors real = image::measureErrors(sum.mean(), constant(2.0F, 100, 100), 0.0);
    EXPECT_NEAR(real.relMse / stated.relMse, 1.0, 0.05);
}

TEST(MeanImage, GoesOnWhereItWasLeft) {
    image::MeanImage whole(2, 1);
    image::MeanImage part(2, 1);
    for (int i = 0; i < 6; ++i) {
        const LinearImage block = constant(static_cast<float>(i * i), 2, 1);
        whole.add(block);
        if (i < 4) {
            part.add(block);
        }
    }
    image::MeanImage restored = image::MeanImage::restore(part.mean(), part.standardError(), part.blocks());
    restored.add(constant(16.0F, 2, 1));
    restored.add(constant(25.0F, 2, 1));
    EXPECT_EQ(restored.blocks(), whole.blocks());
    EXPECT_NEAR(restored.mean().pixels[1][2], whole.mean().pixels[1][2], 1e-5);
    EXPECT_NEAR(restored.standardError().pixels[0][0], whole.standardError().pixels[0][0], 1e-5);
}

}  // namespace
}  // namespace glint
