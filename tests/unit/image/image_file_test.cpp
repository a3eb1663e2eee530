#include "image/image_file.h"

#include "base/files.h"
#include "base/image_limits.h"
#include "image/exr.h"
#include "image/tone.h"
#include "support/must.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <string>

namespace glint {
namespace {

namespace fs = std::filesystem;

class ImageFile : public testing::Test {
protected:
    void SetUp() override {
        const std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
        folder_ = fs::path(GLINT_BINARY_DIR) / "tests" / "tmp" / ("image_" + name);
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    void TearDown() override {
        fs::remove_all(folder_);
    }
    fs::path path(const std::string& name) const {
        return folder_ / name;
    }

private:
    fs::path folder_;
};

LinearImage ramp(std::uint32_t width, std::uint32_t height) {
    LinearImage image{width, height, {}};
    for (std::uint32_t i = 0; i < width * height; ++i) {
        const auto value = static_cast<float>(i);
        image.pixels.push_back({value / 7.0F, value * 1e4F, -value / 3.0F, 0.25F});
    }
    return image;
}

TEST_F(ImageFile, ExrKeepsEveryBit) {
    const LinearImage image = ramp(13, 7);
    ASSERT_TRUE(image::writeImage(path("a.exr"), image, 3.0));
    const LinearImage read = must(image::readImage(path("a.exr")));
    EXPECT_EQ(read.width, 13U);
    EXPECT_EQ(read.height, 7U);
    EXPECT_EQ(read.pixels, image.pixels);
}

TEST_F(ImageFile, ExrKeepsNanAndInfinity) {
    LinearImage image{2, 1, {}};
    image.pixels = {{std::numeric_limits<float>::quiet_NaN(), 0.0F, 0.0F, 1.0F},
                    {std::numeric_limits<float>::infinity(), 0.0F, 0.0F, 1.0F}};
    ASSERT_TRUE(image::writeImage(path("a.exr"), image, 0.0));
    const LinearImage read = must(image::readImage(path("a.exr")));
    EXPECT_TRUE(std::isnan(read.pixels[0][0]));
    EXPECT_TRUE(std::isinf(read.pixels[1][0]));
}

TEST_F(ImageFile, PngRoundTripsDisplayColours) {
    image::DisplayImage image{16, 16, {}};
    for (int i = 0; i < 256; ++i) {
        const auto level = static_cast<std::uint8_t>(i);
        image.pixels.push_back({level, static_cast<std::uint8_t>(255 - i), 7});
    }
    ASSERT_TRUE(writeImage(path("a.png"), image));
    const LinearImage read = must(image::readImage(path("a.png")));
    for (std::size_t i = 0; i < 256; ++i) {
        EXPECT_NEAR(image::linearToSrgb(read.pixels[i][0]) * 255.0F, image.pixels[i][0], 0.01F);
        EXPECT_NEAR(image::linearToSrgb(read.pixels[i][1]) * 255.0F, image.pixels[i][1], 0.01F);
        EXPECT_EQ(read.pixels[i][3], 1.0F);
    }
}

TEST_F(ImageFile, PngIsToneMapped) {
    LinearImage image{1, 1, {{0.5F, 0.3F, 0.2F, 1.0F}}};
    ASSERT_TRUE(image::writeImage(path("a.PNG"), image, -1.0));
    const LinearImage read = must(image::readImage(path("a.PNG")));
    const image::Rgb expected = image::toneMapNeutral({0.25F, 0.15F, 0.1F});
    EXPECT_NEAR(read.pixels[0][0], expected[0], 4e-3F);
    EXPECT_NEAR(read.pixels[0][2], expected[2], 4e-3F);
}

TEST_F(ImageFile, WritesTheSameBytesEveryTime) {
    for (const char* name : {"a.png", "a.exr"}) {
        ASSERT_TRUE(image::writeImage(path(name), ramp(33, 17), 0.0));
        const Result<base::Bytes> first = base::readFile(path(name));
        fs::remove(path(name));
        ASSERT_TRUE(image::writeImage(path(name), ramp(33, 17), 0.0));
        const Result<base::Bytes> second = base::readFile(path(name));
        ASSERT_TRUE(first && second);
        EXPECT_EQ(*first, *second) << name;
    }
}

TEST_F(ImageFile, RefusesUnknownExtensions) {
    for (const char* name : {"a.jpg", "a", "a.png.bak"}) {
        const Status status = image::writeImage(path(name), ramp(2, 2), 0.0);
        ASSERT_FALSE(status) << name;
        EXPECT_EQ(status.error().id, "image-extension");
        EXPECT_FALSE(fs::exists(path(name)));
    }
    EXPECT_EQ(writeImage(path("a.exr"), image::DisplayImage{1, 1, {{1, 2, 3}}}).error().id,
              "image-extension");
}

TEST_F(ImageFile, RefusesMissingAndBrokenFiles) {
    EXPECT_EQ(image::readImage(path("none.png")).error().id, "file-open");
    for (const char* name : {"a.png", "a.exr"}) {
        ASSERT_TRUE(base::writeFile(path(name), std::string_view("not an image at all")));
        const Result<LinearImage> read = image::readImage(path(name));
        ASSERT_FALSE(read) << name;
        EXPECT_EQ(read.error().id, "image-format");
        EXPECT_EQ(read.error().where, path(name).string());
    }
}

// A file that is cut anywhere is refused or, if only trailing bytes are missing, read. It never crashes.
TEST_F(ImageFile, SurvivesTruncation) {
    for (const char* name : {"a.png", "a.exr"}) {
        ASSERT_TRUE(image::writeImage(path(name), ramp(9, 9), 0.0));
        const base::Bytes whole = must(base::readFile(path(name)));
        int refused = 0;
        for (std::size_t size = 0; size < whole.size(); size += 7) {
            const base::Bytes part(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
            ASSERT_TRUE(base::writeFile(path(name), part));
            refused += image::readImage(path(name)) ? 0 : 1;
        }
        EXPECT_GT(refused, 10) << name;
    }
}

std::string little(std::uint32_t word) {
    std::string bytes(sizeof word, 0);
    std::memcpy(bytes.data(), &word, sizeof word);
    return bytes;
}

TEST(PngBounds, ChunksLieInTheFile) {
    const auto excessOf = [](const std::string& chunks) {
        const std::string header("\x89PNG\r\n\x1A\n\0\0\0\x0DIHDR\0\0\0\2\0\0\0\2\x08\6\0\0\0\0\0\0\0", 33);
        return base::findPngExcess(base::asBytes(header + chunks), 2, 2);
    };
    // The header of a chunk of 651 MB, with which the file ends, and a part of its data.
    EXPECT_NE(excessOf("\x26\xD0\x04\x49IDAT").find("651166793 bytes"), std::string::npos);
    EXPECT_NE(excessOf("\x26\xD0\x04\x49IDATx").find("651166793 bytes"), std::string::npos);
    EXPECT_NE(excessOf(std::string("\0\0\0\0IDAT\0\0\0\0", 12)), "");
    EXPECT_EQ(excessOf(std::string("\0\0\0\1IDATx\0\0\0\0\0\0\0\0IDAT\0\0\0\0", 25)), "");
    // Its checksum is a part of a chunk, but that of the last chunk is never read.
    EXPECT_NE(excessOf(std::string("\0\0\0\1IDATx\0\0\0", 12)), "");
    EXPECT_EQ(excessOf(std::string("\0\0\0\1IDATx\0\0\0\0\0\0\0\0IEND", 21)), "");
}

TEST(ExrBounds, BlocksOfPixelsAreSmall) {
    const auto attribute = [](const std::string& name, const std::string& type, const std::string& value) {
        return name + '\0' + type + '\0' + little(static_cast<std::uint32_t>(value.size())) + value;
    };
    const auto channels = [&](int count, std::uint32_t type) {
        std::string list;
        for (int i = 0; i < count; ++i) {
            list += "c" + std::to_string(i) + '\0' + little(type) + little(0) + little(1) + little(1);
        }
        return attribute("channels", "chlist", list + '\0');
    };
    const auto excessOf = [&](const std::string& attributes) {
        return image::findExrExcess(base::asBytes(little(20000630) + little(2) + attributes + '\0'));
    };
    const auto tiles = [&](std::uint32_t width, std::uint32_t height) {
        return attribute("tiles", "tiledesc", little(width) + little(height) + '\0');
    };
    const auto window = [&](std::uint32_t width) {
        return attribute("dataWindow", "box2i", little(0) + little(0) + little(width - 1) + little(0));
    };
    const auto compression = [&](char number) {
        return attribute("compression", "compression", std::string(1, number));
    };
    constexpr std::uint32_t kHalf = 1;
    constexpr std::uint32_t kFloat = 2;
    constexpr char kDwab = 9;
    EXPECT_EQ(excessOf(channels(4, kFloat) + compression(kDwab) + window(16384)), "");
    EXPECT_NE(excessOf(channels(9, kFloat) + compression(kDwab) + window(16384)), "");
    EXPECT_EQ(excessOf(channels(9, kFloat) + compression(0) + window(16384)), "");
    EXPECT_EQ(excessOf(channels(4, kHalf) + window(1) + tiles(4096, 4096)), "");
    EXPECT_NE(excessOf(channels(5, kHalf) + window(1) + tiles(4096, 4096)), "");
    EXPECT_NE(excessOf(tiles(0xFFFFFFFF, 0xFFFFFFFF) + channels(1, kHalf)), "");
}

TEST(ImageSize, HasLimits) {
    EXPECT_TRUE(base::checkImageSize(1, 1, ""));
    EXPECT_TRUE(base::checkImageSize(16384, 4096, ""));
    EXPECT_FALSE(base::checkImageSize(0, 4, ""));
    EXPECT_FALSE(base::checkImageSize(16385, 1, ""));
    EXPECT_FALSE(base::checkImageSize(16384, 4097, ""));
    EXPECT_FALSE(base::checkImageSize(std::int64_t{1} << 40, std::int64_t{1} << 40, ""));
}

}  // namespace
}  // namespace glint
