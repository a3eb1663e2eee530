#include "image/image_file.h"
#include "support/hdr_writer.h"
#include "support/must.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace glint {
namespace {

using testing::encodeHdr;
using testing::HdrEncoding;

constexpr int kWidth = 150;
constexpr int kHeight = 5;

// RGBE holds these numbers exactly: 8 bits of mantissa with a common exponent.
std::vector<std::array<float, 3>> exactPixels() {
    std::vector<std::array<float, 3>> pixels;
    for (int i = 0; i < kWidth * kHeight; ++i) {
        const float scale = std::ldexp(1.0F, i % 40 - 20);
        pixels.push_back(
            {scale * static_cast<float>(128 + i % 128), scale * static_cast<float>(i % 256), 0.0F});
    }
    pixels[7] = {0.0F, 0.0F, 0.0F};
    return pixels;
}

class Hdr : public ::testing::TestWithParam<HdrEncoding> {};

INSTANTIATE_TEST_SUITE_P(Encodings, Hdr, ::testing::Values(HdrEncoding::Flat, HdrEncoding::RunLength),
                         [](const ::testing::TestParamInfo<HdrEncoding>& encoding) {
                             return encoding.param == HdrEncoding::Flat ? "Flat" : "RunLength";
                         });

TEST_P(Hdr, ReadsWhatWasWritten) {
    const auto pixels = exactPixels();
    const LinearImage image = must(image::decodeHdr(encodeHdr(kWidth, kHeight, pixels, GetParam()), "a.hdr"));
    ASSERT_EQ(image.width, 150U);
    ASSERT_EQ(image.height, 5U);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        for (std::size_t channel = 0; channel < 3; ++channel) {
            // The common exponent is that of the largest value, whose mantissa is cut to 8 bits.
            const float step = std::max(pixels[i][0], pixels[i][1]) / 128.0F;
            EXPECT_NEAR(image.pixels[i][channel], pixels[i][channel], step) << i;
        }
        EXPECT_EQ(image.pixels[i][3], 1.0F);
    }
    EXPECT_EQ(image.pixels[0][0], pixels[0][0]);
}

TEST_P(Hdr, RefusesEveryTruncation) {
    const std::vector<std::uint8_t> whole = encodeHdr(kWidth, kHeight, exactPixels(), GetParam());
    for (std::size_t size = 0; size < whole.size(); ++size) {
        const Result<LinearImage> image = image::decodeHdr({whole.data(), size}, "a.hdr");
        ASSERT_FALSE(image) << size << " of " << whole.size();
        EXPECT_EQ(image.error().where, "a.hdr");
    }
}

// Any byte may be wrong. The result is an image of the same size, or a diagnostic.
TEST_P(Hdr, SurvivesBrokenBytes) {
    const std::vector<std::uint8_t> whole = encodeHdr(kWidth, kHeight, exactPixels(), GetParam());
    int refused = 0;
    for (std::size_t i = 0; i < whole.size(); ++i) {
        for (const int value : {0, 127, 255}) {
            std::vector<std::uint8_t> broken = whole;
            broken[i] = static_cast<std::uint8_t>(value);
            const Result<LinearImage> image = image::decodeHdr(broken, "a.hdr");
            refused += image ? 0 : 1;
            if (image) {
                ASSERT_EQ(image->pixels.size(), std::size_t{image->width} * image->height);
            }
        }
    }
    EXPECT_GT(refused, 50);
}

TEST(HdrHeader, RefusesOtherFilesAndSizesThatTheFileCanNotHold) {
    const auto errorOf = [](const std::string& text) {
        const Result<LinearImage> image =
            image::decodeHdr({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, "a.hdr");
        return image ? std::string() : image.error().id + ": " + image.error().message;
    };
    EXPECT_NE(errorOf("").find("image-format"), std::string::npos);
    EXPECT_NE(errorOf("not a picture").find("image-format"), std::string::npos);
    const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
    EXPECT_NE(errorOf(header + "-Y 8000 +X 8000\nabc").find("has only"), std::string::npos);
    EXPECT_NE(errorOf(header + "-Y 20000 +X 40000\nabc").find("image-size"), std::string::npos);
    EXPECT_NE(errorOf(header + "+Y 2 +X 2\nabc").find("image-format"), std::string::npos);
}

TEST(RadianceFiles, AreKnownByTheirExtension) {
    EXPECT_EQ(*image::radianceFormat("a.hdr"), image::RadianceFormat::Hdr);
    EXPECT_EQ(*image::radianceFormat("folder.png/a.EXR"), image::RadianceFormat::Exr);
    for (const char* name : {"a.png", "a", "hdr"}) {
        ASSERT_FALSE(image::radianceFormat(name)) << name;
        EXPECT_EQ(image::radianceFormat(name).error().id, "image-extension");
    }
    EXPECT_EQ(image::readRadiance("none.hdr").error().id, "file-open");
}

}  // namespace
}  // namespace glint
