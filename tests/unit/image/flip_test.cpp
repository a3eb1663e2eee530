#include "image/compare.h"
#include "image/tone.h"
#include "unit/image/flip_oracle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace glint::testing {
namespace {

LinearImage constant(const image::Rgb& color, std::uint32_t width = 24, std::uint32_t height = 16) {
    LinearImage image{width, height, {}};
    image.pixels.assign(std::size_t{width} * height, {color[0], color[1], color[2], 1.0F});
    return image;
}

// Returns a picture with gradients, an edge, a line, single bright pixels and saturated colours.
LinearImage picture(std::uint32_t width, std::uint32_t height) {
    LinearImage image = constant({0.0F, 0.0F, 0.0F}, width, height);
    for (std::uint32_t y = 0; y < height; ++y) {
        for (std::uint32_t x = 0; x < width; ++x) {
            const float u = static_cast<float>(x) / static_cast<float>(width);
            const float v = static_cast<float>(y) / static_cast<float>(height);
            std::array<float, 4>& pixel = image.pixels[std::size_t{y} * width + x];
            pixel = {u, v, 0.5F + 0.5F * std::sin(9.0F * u * v), 1.0F};
            if (x > width / 2) {
                pixel = {0.1F * v, 0.8F, 0.2F * u, 1.0F};
            }
            if (y == height / 3 || (x * 7 + y * 13) % 97 == 0) {
                pixel = {1.0F, 1.0F, 1.0F, 1.0F};
            }
        }
    }
    return image;
}

LinearImage withNoise(LinearImage image, float amount) {
    std::minstd_rand random(7);
    std::uniform_real_distribution<float> distribution(-1.0F, 1.0F);
    for (std::array<float, 4>& pixel : image.pixels) {
        for (std::size_t i = 0; i < 3; ++i) {
            pixel[i] = std::clamp(pixel[i] + amount * distribution(random), 0.0F, 1.0F);
        }
    }
    return image;
}

// Averages over squares of pixels up to `radius` away.
LinearImage blurred(const LinearImage& image, int radius) {
    LinearImage result = image;
    const int width = static_cast<int>(image.width);
    const int height = static_cast<int>(image.height);
    const auto at = [width](int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    };
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            for (std::size_t c = 0; c < 3; ++c) {
                float sum = 0.0F;
                for (int j = -radius; j <= radius; ++j) {
                    for (int i = -radius; i <= radius; ++i) {
                        sum += image.pixels[at(std::clamp(x + i, 0, width - 1),
                                               std::clamp(y + j, 0, height - 1))][c];
                    }
                }
                result.pixels[at(x, y)][c] = sum / static_cast<float>((2 * radius + 1) * (2 * radius + 1));
            }
        }
    }
    return result;
}

double mean(const LinearImage& image, const LinearImage& reference) {
    return image::flipMean(image::flipMap(image, reference));
}

TEST(Flip, EqualPicturesDoNotDiffer) {
    const LinearImage image = picture(40, 30);
    for (const float value : image::flipMap(image, image)) {
        ASSERT_EQ(value, 0.0F);
    }
}

TEST(Flip, TakesPicturesOfAnySize) {
    EXPECT_TRUE(image::flipMap({0, 0, {}}, {0, 0, {}}).empty());
    EXPECT_EQ(image::flipMean({}), 0.0);
    for (const auto& [width, height] : {std::pair{1U, 1U}, {1U, 50U}, {50U, 1U}, {3U, 2U}}) {
        const std::vector<float> map = image::flipMap(constant({0.0F, 0.0F, 1.0F}, width, height),
                                                      constant({0.0F, 1.0F, 0.0F}, width, height));
        ASSERT_EQ(map.size(), std::size_t{width} * height);
        for (const float value : map) {
            EXPECT_NEAR(value, 1.0F, 1e-6F);
        }
    }
}

// Without edges and points only the colour pipeline is left: XYZ, L*a*b*, Hunt, HyAB, power 0.7, the bend of
// the range. The values were computed without this code, with the matrix of ITU-R BT.709.
TEST(Flip, ConstantPicturesHaveTheDifferenceOfTheirColors) {
    struct Row {
        image::Rgb a, b;
        double expected;
    };
    const Row rows[] = {
        {{1.0F, 1.0F, 1.0F}, {0.0F, 0.0F, 0.0F}, 0.967379182},
        {{0.5F, 0.5F, 0.5F}, {0.6F, 0.6F, 0.6F}, 0.196212468},
        {{0.2F, 0.5F, 0.1F}, {0.25F, 0.45F, 0.1F}, 0.265221852},
        {{1.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F}, 0.986661415},
        {{1.0F, 0.0F, 1.0F}, {0.0F, 1.0F, 0.0F}, 0.999409601},
        {{0.0F, 0.0F, 1.0F}, {0.0F, 1.0F, 0.0F}, 1.0},
        {{0.18F, 0.18F, 0.18F}, {0.0F, 0.0F, 0.0F}, 0.883404773},
    };
    for (const Row& row : rows) {
        for (const float value : image::flipMap(constant(row.a), constant(row.b))) {
            ASSERT_NEAR(value, row.expected, 1e-6) << row.a[0] << ' ' << row.a[1] << ' ' << row.a[2];
        }
    }
}

TEST(Flip, AgreesWithThePlainEvaluation) {
    const LinearImage reference = picture(37, 29);
    for (const double perDegree : {20.0, image::kFlipPixelsPerDegree}) {
        for (const LinearImage& image :
             {withNoise(reference, 0.2F), blurred(reference, 2), constant({0.3F, 0.3F, 0.3F}, 37, 29)}) {
            const std::vector<float> map = image::flipMap(image, reference, perDegree);
            const std::vector<double> plain = plainFlip(image, reference, perDegree);
            for (std::size_t i = 0; i < map.size(); ++i) {
                ASSERT_NEAR(map[i], plain[i], 1e-4) << "pixel " << i << " at " << perDegree;
            }
        }
    }
}

TEST(Flip, IsSymmetricAndWithinItsRange) {
    const LinearImage reference = picture(40, 30);
    const LinearImage image = withNoise(reference, 0.5F);
    const std::vector<float> map = image::flipMap(image, reference);
    EXPECT_EQ(map, image::flipMap(reference, image));
    for (const float value : map) {
        ASSERT_GE(value, 0.0F);
        ASSERT_LE(value, 1.0F);
    }
}

TEST(Flip, GrowsWithNoiseAndBlur) {
    const LinearImage reference = picture(64, 48);
    double last = 0.0;
    for (const float amount : {0.01F, 0.03F, 0.1F, 0.3F, 0.9F}) {
        const double value = mean(withNoise(reference, amount), reference);
        EXPECT_GT(value, last) << amount;
        last = value;
    }
    last = 0.0;
    for (const int radius : {1, 2, 4, 8}) {
        const double value = mean(blurred(reference, radius), reference);
        EXPECT_GT(value, last) << radius;
        last = value;
    }
}

// A single pixel is easier to see from near than from far.
TEST(Flip, NearerPixelsAreSeenBetter) {
    const LinearImage reference = constant({0.2F, 0.2F, 0.2F}, 41, 41);
    LinearImage image = reference;
    image.pixels[20 * 41 + 20] = {1.0F, 1.0F, 1.0F, 1.0F};
    const auto largest = [&](double perDegree) {
        const std::vector<float> map = image::flipMap(image, reference, perDegree);
        return *std::max_element(map.begin(), map.end());
    };
    EXPECT_GT(largest(20.0), largest(40.0));
    EXPECT_GT(largest(40.0), largest(80.0));
}

TEST(Flip, ClampsWhatNoDisplayShows) {
    const float infinity = std::numeric_limits<float>::infinity();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(mean(constant({infinity, 2.0F, 1.0F}), constant({1.0F, 1.0F, 1.0F})), 0.0);
    EXPECT_EQ(mean(constant({nan, -infinity, -1.0F}), constant({0.0F, 0.0F, 0.0F})), 0.0);
}

}  // namespace
}  // namespace glint::testing
