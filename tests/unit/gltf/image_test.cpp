// Tests image formats: PNG of every kind, WebP, and which source of a texture is used. ktx2_test.cpp tests
// KTX2.
#include "gltf/texels/levels.h"
#include "gltf/texels/texel_bounds.h"
#include "support/must.h"
#include "unit/gltf/packed_scenes.h"
#include "unit/gltf/png_writer.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

namespace glint::test {
namespace {

const gltf::ImportOptions kDecode{.decodeImages = true};

gltf::Image decodePng(const PngSpec& spec) {
    Result<gltf::Scene> scene = import(sceneWithImage(makePng(spec)), kDecode);
    if (!scene || scene->images.empty()) {
        ADD_FAILURE() << (scene ? "no image" : toString(scene.error()));
        return {};
    }
    return scene->images[0];
}

std::vector<int> channels16(const gltf::Image& image) {
    std::vector<int> channels;
    for (std::size_t i = 0; i + 2 <= image.pixels.size(); i += 2) {
        std::uint16_t channel = 0;
        std::memcpy(&channel, &image.pixels[i], sizeof channel);
        channels.push_back(channel);
    }
    return channels;
}

TEST(GltfPng, KeepsSixteenBits) {
    const gltf::Image rgba = decodePng({1,
                                        2,
                                        16,
                                        PngColor::Rgba,
                                        {},
                                        {0x12, 0x34, 0x56, 0x78, 0x9A, 0xBC, 0xDE, 0xF0,  //
                                         0x00, 0x01, 0xFF, 0xFE, 0x80, 0x00, 0x00, 0x00}});
    EXPECT_EQ(rgba.format, gltf::PixelFormat::Rgba16);
    EXPECT_EQ(channels16(rgba),
              (std::vector{0x1234, 0x5678, 0x9ABC, 0xDEF0, 0x0001, 0xFFFE, 0x8000, 0x0000}));
    const gltf::Image rgb = decodePng({1, 1, 16, PngColor::Rgb, {}, {0x12, 0x34, 0x56, 0x78, 0x9A, 0xBC}});
    EXPECT_EQ(channels16(rgb), (std::vector{0x1234, 0x5678, 0x9ABC, 0xFFFF}));
    const gltf::Image gray = decodePng({1, 1, 16, PngColor::Gray, {}, {0x12, 0x34}});
    EXPECT_EQ(channels16(gray), (std::vector{0x1234, 0x1234, 0x1234, 0xFFFF}));
    const gltf::Image grayAlpha = decodePng({1, 1, 16, PngColor::GrayAlpha, {}, {0x12, 0x34, 0x56, 0x78}});
    EXPECT_EQ(channels16(grayAlpha), (std::vector{0x1234, 0x1234, 0x1234, 0x5678}));
}

TEST(GltfPng, SixteenBitsHaveATransparentColour) {
    const gltf::Image image =
        decodePng({2, 1, 16, PngColor::Gray, {{"tRNS", {0x12, 0x34}}}, {0x12, 0x34, 0x12, 0x35}});
    EXPECT_EQ(channels16(image), (std::vector{0x1234, 0x1234, 0x1234, 0, 0x1235, 0x1235, 0x1235, 0xFFFF}));
}

TEST(GltfPng, ReadsGrayPaletteAndTransparency) {
    const gltf::Image gray = decodePng({2, 1, 8, PngColor::Gray, {}, {7, 200}});
    EXPECT_EQ(gray.format, gltf::PixelFormat::Rgba8);
    EXPECT_EQ(gray.pixels, (base::Bytes{7, 7, 7, 255, 200, 200, 200, 255}));
    const gltf::Image bits = decodePng({8, 1, 1, PngColor::Gray, {}, {0x40}});
    EXPECT_EQ(bits.pixels.at(0), 0);
    EXPECT_EQ(bits.pixels.at(4), 255);
    const gltf::Image grayAlpha = decodePng({1, 1, 8, PngColor::GrayAlpha, {}, {7, 9}});
    EXPECT_EQ(grayAlpha.pixels, (base::Bytes{7, 7, 7, 9}));
    const gltf::Image palette = decodePng(
        {3, 1, 8, PngColor::Palette, {{"PLTE", {1, 2, 3, 4, 5, 6, 7, 8, 9}}, {"tRNS", {10, 20}}}, {2, 0, 1}});
    EXPECT_EQ(palette.pixels, (base::Bytes{7, 8, 9, 255, 1, 2, 3, 10, 4, 5, 6, 20}));
    const gltf::Image key =
        decodePng({2, 1, 8, PngColor::Rgb, {{"tRNS", {0, 1, 0, 2, 0, 3}}}, {1, 2, 3, 1, 2, 4}});
    EXPECT_EQ(key.pixels, (base::Bytes{1, 2, 3, 0, 1, 2, 4, 255}));
}

TEST(GltfWebp, RoundTrips) {
    const gltf::Scene scene = must(import(webpScene(), kDecode));
    EXPECT_TRUE(readingWarnings(scene).empty());
    ASSERT_EQ(scene.images.size(), 1U);
    EXPECT_EQ(scene.images[0].width, 2);
    EXPECT_EQ(scene.images[0].height, 1);
    EXPECT_EQ(scene.images[0].pixels, base::Bytes(kWebpPixels.begin(), kWebpPixels.end()));
    EXPECT_EQ(scene.materials[0].texture("baseColorTexture").texture, 0);
}

TEST(GltfWebp, IsPreferredToItsFallback) {
    GltfBuilder builder = webpScene();
    builder.root.erase("extensionsRequired");
    builder.append("images", {{"uri", std::string("data:image/png;base64,") + kPng8}});
    builder.root["textures"][0]["source"] = 1;
    const gltf::Scene scene = must(import(builder, kDecode));
    ASSERT_EQ(scene.images.size(), 1U);
    EXPECT_EQ(scene.images[0].pointer, "/images/0");
}

TEST(GltfWebp, ExplainsDamage) {
    const auto errorOf = [](const GltfBuilder& builder, const gltf::ImportOptions& options = kDecode) {
        const Result<gltf::Scene> scene = import(builder, options);
        if (scene) {
            return std::string("imported");
        }
        EXPECT_FALSE(scene.error().hint.empty());
        return scene.error().id + " " + scene.error().message;
    };
    const base::Bytes whole = encodeWebp(base::Bytes(std::size_t{4} * 64 * 64, 77), 64, 64);
    for (const std::size_t size : {std::size_t{13}, std::size_t{20}, whole.size() - 4}) {
        const std::string error = errorOf(sceneWithImage(
            base::Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)), "image/webp"));
        EXPECT_TRUE(error.starts_with("image-decode is a WebP image that can't be decoded: ")) << error;
    }
    base::Bytes signature = whole;
    signature[20] = 0;  // the first byte of the VP8L stream
    EXPECT_NE(errorOf(sceneWithImage(signature, "image/webp")).find("bitstream error"), std::string::npos);
    EXPECT_TRUE(errorOf(sceneWithImage(whole, "image/webp"), {.decodeImages = true, .maxImageSize = 63})
                    .starts_with("image-size"));
    GltfBuilder range = webpScene();
    range.root["textures"][0]["extensions"]["EXT_texture_webp"]["source"] = 1;
    EXPECT_TRUE(errorOf(range).starts_with("index-range"));
    range.root["textures"][0]["extensions"]["EXT_texture_webp"] = Json::object();
    EXPECT_TRUE(errorOf(range).starts_with("json-missing"));
}

TEST(GltfImages, NamesForeignFormats) {
    for (const auto& [start, name] : {std::pair("DDS ", "DDS"), std::pair("\xABKTX 11\xBB", "KTX 1"),
                                      std::pair("1234ftypavif", "AVIF")}) {
        const std::string text(start);
        const Diagnostic scene =
            mustFail(import(sceneWithImage(base::Bytes(text.begin(), text.end())), kDecode));
        EXPECT_NE(scene.message.find(name), std::string::npos) << scene.message;
    }
}

const gltf::ImportOptions kTrust{.trustTextures = true};

// Returns what the only texture of a scene holds, which is one of colours.
materials::TextureContent contentOf(const PngSpec& spec) {
    const Result<gltf::Scene> scene = import(sceneWithImage(makePng(spec)), kTrust);
    if (!scene || scene->images.empty()) {
        ADD_FAILURE() << (scene ? "no image" : toString(scene.error()));
        return {};
    }
    EXPECT_TRUE(scene->images[0].pixels.empty());
    EXPECT_TRUE(scene->images[0].file.empty());
    return scene->materials[0].texture("baseColorTexture").content;
}

TEST(ImageContent, IsTheLeastAndGreatestOfEachChannel) {
    const materials::TextureContent content =
        contentOf({3, 1, 8, PngColor::Rgba, {}, {0, 51, 255, 102, 255, 51, 255, 204, 51, 51, 255, 153}});
    EXPECT_EQ(content.of[0], (materials::ValueInterval{0.0, 1.0}));
    EXPECT_EQ(content.of[2], (materials::ValueInterval{1.0, 1.0}));
    EXPECT_NEAR(content.of[3].low, 0.4, 1e-4);
    EXPECT_NEAR(content.of[3].high, 0.8, 1e-4);
    EXPECT_TRUE(std::isnan(content.constant[0]));
    EXPECT_NEAR(content.constant[1], 0.0331, 1e-4);  // 0.2 in sRGB
    EXPECT_EQ(content.constant[2], 1.0);
    EXPECT_EQ(content.image, "/images/0");
    EXPECT_EQ(content.leastAt[3].x, 0);
    EXPECT_EQ(content.greatestAt[3].x, 1);
    // Nobody has looked.
    const gltf::Scene unread = must(import(sceneWithImage(makePng({}))));
    EXPECT_EQ(unread.materials[0].texture("baseColorTexture").content.of[0], materials::kUnitInterval);
}

// Devices that cannot filter 16 bits keep 8, which may round to either side.
TEST(ImageContent, OfSixteenBitsHoldsThatOfEight) {
    gltf::TexelRange range;
    range.least.fill(0x4D00);
    range.greatest.fill(0x4D00);
    EXPECT_EQ(valuesOf(range, gltf::PixelFormat::Rgba16, 0)[0],
              (materials::ValueInterval{77.0 * 256.0 / 65535.0, 77.0 / 255.0}));
}

TEST(ImageContent, IsReadAsColourWhereItIsOne) {
    std::array<materials::ValueInterval, 4> stored{};
    stored.fill({0.5, 0.5});
    const auto color = gltf::contentAsRead(stored, true);
    EXPECT_LT(color[0].low, 0.21404);
    EXPECT_GT(color[0].high, 0.21405);
    EXPECT_NEAR(color[0].low, 0.214, 0.003);
    EXPECT_NEAR(color[3].high, 0.5, 1e-4);
    EXPECT_NEAR(gltf::contentAsRead(stored, false)[0].low, 0.5, 1e-4);
    // The ends are exact.
    stored.fill({0.0, 0.0});
    EXPECT_EQ(gltf::contentAsRead(stored, true)[1], (materials::ValueInterval{0.0, 0.0}));
    stored.fill({1.0, 1.0});
    EXPECT_EQ(gltf::contentAsRead(stored, true)[1], (materials::ValueInterval{1.0, 1.0}));
    stored.fill({0.0, 1.0});
    EXPECT_EQ(gltf::contentAsRead(stored, true)[1], (materials::ValueInterval{0.0, 1.0}));
}

}  // namespace
}  // namespace glint::test
