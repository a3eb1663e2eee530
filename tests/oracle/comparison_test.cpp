// Tests the comparison itself: it accepts a picture of the truth and sees small faults.
#include "oracle/comparison.h"

#include <gtest/gtest.h>

namespace {

using namespace glint;
using namespace glint::oracle;

constexpr std::uint32_t kWidth = 40;
constexpr std::uint32_t kHeight = 25;
constexpr std::uint32_t kSamples = 256;

// Returns pixels for which a random sample is 1 with a probability between 0 and 0.8, else 0.
std::vector<PixelTruth> chances() {
    std::vector<PixelTruth> truths;
    for (std::uint32_t i = 0; i < kWidth * kHeight; ++i) {
        const Vec3 chance(0.8 * i / (kWidth * kHeight - 1));
        truths.push_back({i % kWidth, i / kWidth, {chance, Vec3(0.0), chance}});
    }
    return truths;
}

// Returns what a device would render whose samples count `scale` and are off by `offset`.
LinearImage picture(const std::vector<PixelTruth>& truths, std::uint64_t seed, double scale = 1.0,
                    double offset = 0.0) {
    LinearImage image{kWidth, kHeight, {}};
    Random random(seed);
    for (const PixelTruth& truth : truths) {
        double sum = 0.0;
        for (std::uint32_t sample = 0; sample < kSamples; ++sample) {
            sum += random.next() < truth.light.mean.x ? scale : 0.0;
        }
        const auto value = static_cast<float>(sum / kSamples + offset);
        image.pixels.push_back({value, value, value, 1.0F});
    }
    return image;
}

const Subject kSubject{"none", "chances", "themselves", 1, kSamples, 1.0, 0.0};

TEST(OracleComparison, AcceptsSamplesOfTheTruth) {
    const auto truths = chances();
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
        const Comparison comparison = compare(picture(truths, seed), truths, kSubject);
        EXPECT_TRUE(comparison.objections.empty()) << comparison.objections[0];
        EXPECT_NEAR(comparison.rootMeanSquare / comparison.expected, 1.0, 0.1);
        EXPECT_EQ(comparison.pixels, truths.size());
        EXPECT_NEAR(comparison.mean, 0.4, 1e-12);
    }
}

TEST(OracleComparison, SeesAWeightThatIsOffByTwoPercent) {
    const auto truths = chances();
    for (const double scale : {0.98, 1.02}) {
        EXPECT_FALSE(compare(picture(truths, 1, scale), truths, kSubject).objections.empty());
    }
}

TEST(OracleComparison, SeesOneWrongPixelAndAPictureThatIsNoNumber) {
    const auto truths = chances();
    LinearImage image = picture(truths, 1);
    image.pixels[100][0] += 0.25F;
    const Comparison comparison = compare(image, truths, kSubject);
    ASSERT_EQ(comparison.objections.size(), 1U);
    EXPECT_NE(comparison.objections[0].find("pixel (20, 2)"), std::string::npos) << comparison.objections[0];
    image.pixels[100][0] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(compare(image, truths, kSubject).objections.size(), 3U);
}

// Neither the mean nor any pixel shows the fault.
TEST(OracleComparison, SeesAPictureTooBrightOnOneSideAndTooDarkOnTheOther) {
    const auto truths = chances();
    LinearImage image = picture(truths, 1);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        image.pixels[i][0] += i < image.pixels.size() / 2 ? 0.02F : -0.02F;
    }
    const Comparison comparison = compare(image, truths, kSubject);
    EXPECT_LE(comparison.worst, 1.0);
    EXPECT_GT(comparison.worstTile, 1.0);
    EXPECT_FALSE(comparison.objections.empty());
}

TEST(OracleComparison, SeesPixelsThatSpreadTooFar) {
    const auto truths = chances();
    // The picture has the noise of half the samples.
    Subject subject = kSubject;
    subject.samples = 2 * kSamples;
    EXPECT_FALSE(compare(picture(truths, 1), truths, subject).objections.empty());
}

TEST(OracleComparison, AllowsTheBiasThatIsStated) {
    const auto truths = chances();
    Subject subject = kSubject;
    subject.bias = 0.01;
    EXPECT_TRUE(compare(picture(truths, 1, 1.0, 0.009), truths, subject).objections.empty());
    EXPECT_FALSE(compare(picture(truths, 1, 1.0, 0.03), truths, subject).objections.empty());
}

}  // namespace
