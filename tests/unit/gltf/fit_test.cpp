// Tests how images become what a device reads: levels, formats by their use, and packed blocks.
#include "gltf/texels/fit.h"

#include "gltf/codecs/codecs.h"
#include "gltf/texels/levels.h"
#include "support/must.h"
#include "unit/gltf/block_files.h"
#include "unit/gltf/gltf_builder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

namespace glint::test {
namespace {

gltf::Texels texelsOf(int width, int height, std::vector<std::uint8_t> bytes) {
    return {{width, height}, gltf::PixelFormat::Rgba8, std::move(bytes)};
}

// The mean of black and white is half of the light, 188 in sRGB.
TEST(Levels, ColoursAreAveragedInLinearLight) {
    gltf::Texels texels = texelsOf(2, 2, {0, 0, 0, 0, 255, 255, 255, 255, 255, 255, 255, 255, 0, 0, 0, 0});
    completeLevels(texels, gltf::filtersOf(gltf::LevelFilter::Color));
    ASSERT_EQ(texels.levels, 2);
    EXPECT_EQ(texels.bytes[16], 188);
    EXPECT_EQ(texels.bytes[19], 128);  // alpha is linear
    texels = texelsOf(2, 2, {0, 0, 0, 0, 255, 255, 255, 255, 255, 255, 255, 255, 0, 0, 0, 0});
    completeLevels(texels, gltf::filtersOf(gltf::LevelFilter::Data));
    EXPECT_EQ(texels.bytes[16], 128);
}

// 5 texels become 2: each covers two and a half.
TEST(Levels, OddSizesAreWeightedByArea) {
    gltf::Texels texels = texelsOf(5, 1, {});
    for (const std::uint8_t value : std::array<std::uint8_t, 5>{0, 0, 250, 100, 100}) {
        texels.bytes.insert(texels.bytes.end(), {value, value, value, value});
    }
    completeLevels(texels, gltf::filtersOf(gltf::LevelFilter::Data));
    ASSERT_EQ(texels.levels, 3);
    EXPECT_EQ(texels.bytes[20], 50);   // (0 + 0 + 125) / 2.5
    EXPECT_EQ(texels.bytes[24], 130);  // (125 + 100 + 100) / 2.5
    EXPECT_EQ(texels.bytes[28], 90);   // the mean of all
}

TEST(Levels, MeansOfVectorsAreUnitVectors) {
    // (1, 0, 0) and (0, 1, 0), and two that cancel.
    gltf::Texels texels = texelsOf(2, 1, {255, 128, 128, 255, 128, 255, 128, 255});
    completeLevels(texels, gltf::filtersOf(gltf::LevelFilter::Normals));
    const double half = 127.5 + 127.5 / std::sqrt(2.0);
    EXPECT_NEAR(texels.bytes[8], half, 1.0);
    EXPECT_NEAR(texels.bytes[9], half, 1.0);
    EXPECT_NEAR(texels.bytes[10], 128, 1.0);
}

TEST(Levels, SixteenBitsStaySixteen) {
    std::vector<std::uint8_t> bytes(16);
    const std::uint16_t values[8] = {1000, 0, 0, 65535, 1003, 65535, 0, 65535};
    std::memcpy(bytes.data(), values, sizeof values);
    gltf::Texels texels{{2, 1}, gltf::PixelFormat::Rgba16, bytes};
    completeLevels(texels, gltf::filtersOf(gltf::LevelFilter::Data));
    std::uint16_t mean[4]{};
    ASSERT_EQ(texels.bytes.size(), 24U);
    std::memcpy(mean, &texels.bytes[16], sizeof mean);
    EXPECT_NEAR(mean[0], 1001.5, 0.51);
    EXPECT_NEAR(mean[1], 32767.5, 0.51);
}

// Squares of the roughnesses 0.1 and 0.9.
gltf::Texels squaresOf(int width, int height) {
    gltf::Texels texels = texelsOf(width, height, {});
    for (int i = 0; i < width * height; ++i) {
        const bool isRough = (i % width + i / width) % 2 == 0;
        const std::uint8_t code = isRough ? 230 : 26;
        texels.bytes.insert(texels.bytes.end(), {code, code, code, static_cast<std::uint8_t>(255 - code)});
    }
    return texels;
}

// The mean of r², whichever level it is made for; levels are not made from ones that were rounded.
TEST(Levels, RoughnessIsAveragedByAlpha) {
    using enum gltf::LevelFilter;
    gltf::Texels texels = squaresOf(8, 8);
    completeLevels(texels, {Data, Roughness, Data, Glossiness});
    ASSERT_EQ(texels.levels, 4);
    const double smooth = 26.0 / 255.0;
    const double rough = 230.0 / 255.0;
    const double mean = std::sqrt(0.5 * (smooth * smooth + rough * rough));
    const auto code = [](double value) { return static_cast<int>(std::lround(255.0 * value)); };
    for (std::size_t texel = 64; texel < texels.bytes.size() / 4; ++texel) {
        EXPECT_EQ(texels.bytes[4 * texel], 128);
        EXPECT_EQ(texels.bytes[4 * texel + 1], code(mean));
        EXPECT_EQ(texels.bytes[4 * texel + 2], 128);
        EXPECT_EQ(texels.bytes[4 * texel + 3], 255 - code(mean));
    }
}

TexelFormats formatsOf(std::initializer_list<TexelFormat> formats) {
    TexelFormats all;
    all.add(TexelFormat::Rgba8, false);
    all.add(TexelFormat::Rgba8, true);
    for (const TexelFormat format : formats) {
        all.add(format, false);
        if (infoOf(format).hasSrgb) {
            all.add(format, true);
        }
    }
    return all;
}
const TexelFormats kDesktop = formatsOf({TexelFormat::Bc1, TexelFormat::Bc2, TexelFormat::Bc3,
                                         TexelFormat::Bc4, TexelFormat::Bc5, TexelFormat::Bc7});
const TexelFormats kMobile = formatsOf({TexelFormat::Etc2Rgb, TexelFormat::Etc2Rgba, TexelFormat::Astc4x4});

TEST(Fit, TargetsFollowTheUse) {
    using enum TexelFormat;
    const gltf::ImageUse color{true, false, false, false, 15};
    const gltf::ImageUse normals{false, true, true, false, 7};
    const gltf::ImageUse roughness{false, true, false, false, 2};
    const gltf::ImageUse metallicRoughness{false, true, false, false, 6};
    const gltf::ImageUse both{true, true, false, false, 2};
    EXPECT_EQ(targetFormat(color, true, false, kDesktop), Bc7);
    EXPECT_EQ(targetFormat(normals, false, false, kDesktop), Bc5);
    EXPECT_EQ(targetFormat(roughness, false, false, kDesktop), Bc4);
    EXPECT_EQ(targetFormat(metallicRoughness, false, false, kDesktop), Bc5);
    EXPECT_EQ(targetFormat(both, false, false, kDesktop), Bc7);
    EXPECT_EQ(targetFormat(color, true, false, formatsOf({Bc1, Bc3})), Bc3);
    EXPECT_EQ(targetFormat(color, false, false, formatsOf({Bc1, Bc3})), Bc1);
    for (const gltf::ImageUse& use : {color, normals, roughness, metallicRoughness}) {
        EXPECT_EQ(targetFormat(use, true, false, kMobile), Astc4x4);
        EXPECT_EQ(targetFormat(use, true, true, kMobile), Rgba8);
        EXPECT_EQ(targetFormat(use, true, false, formatsOf({})), Rgba8);
    }
}

TEST(Fit, UsesComeFromTheMaterials) {
    GltfBuilder builder = sceneWithImage(base::Bytes(4));
    builder.root["images"] = Json::array();
    builder.root["textures"] = Json::array();
    for (int i = 0; i < 4; ++i) {
        builder.append("images", {{"uri", std::string("data:image/png;base64,") + kPng8}});
        builder.append("textures", {{"source", i}});
    }
    builder.root["materials"][0] = {
        {"pbrMetallicRoughness",
         {{"baseColorTexture", {{"index", 0}}}, {"metallicRoughnessTexture", {{"index", 1}}}}},
        {"normalTexture", {{"index", 2}}},
        {"occlusionTexture", {{"index", 1}}},
        {"emissiveTexture", {{"index", 3}}},
        {"emissiveFactor", {1, 1, 1}}};
    const gltf::Scene scene = must(import(builder, {.decodeImages = true}));
    const auto uses = imageUses(scene);
    ASSERT_EQ(uses.size(), 4U);
    // Images have the order of their first use.
    const auto useOf = [&](const char* pointer) {
        for (std::size_t i = 0; i < uses.size(); ++i) {
            if (scene.images[i].pointer == pointer) {
                return uses[i];
            }
        }
        return gltf::ImageUse();
    };
    EXPECT_EQ(useOf("/images/0"), (gltf::ImageUse{true, false, false, false, 15}));
    EXPECT_EQ(useOf("/images/1"), (gltf::ImageUse{false, true, false, false, 7, 2}));
    EXPECT_EQ(useOf("/images/2"), (gltf::ImageUse{false, true, true, false, 7}));
    EXPECT_EQ(useOf("/images/3"), (gltf::ImageUse{true, false, false, true, 7}));
}

// A channel is averaged as roughness if all textures read it so: of colours, alpha can hold it.
TEST(Fit, RoughnessIsFoundByTheDeclarations) {
    gltf::Scene scene;
    scene.images.resize(4);
    scene.samplers.emplace_back();
    for (int i = 0; i < 4; ++i) {
        scene.textures.push_back({i, 0});
    }
    materials::Material coated;
    coated.give("KHR_materials_clearcoat");
    coated.give("KHR_materials_volume");
    coated.texture("metallicRoughnessTexture").texture = 0;
    coated.texture("occlusionTexture").texture = 0;
    coated.texture("clearcoatRoughnessTexture").texture = 1;
    coated.texture("thicknessTexture").texture = 1;  // the same channel
    materials::Material glossy;
    glossy.give("KHR_materials_pbrSpecularGlossiness");
    glossy.texture("metallicRoughnessTexture").texture = 2;
    materials::Material plain;
    plain.texture("baseColorTexture").texture = 3;
    scene.materials = {coated, glossy, plain};
    const std::vector<gltf::ImageUse> uses = imageUses(scene);
    using enum gltf::LevelFilter;
    EXPECT_EQ(levelFiltersOf(uses[0]), (gltf::LevelFilters{Data, Roughness, Data, Data}));
    EXPECT_EQ(levelFiltersOf(uses[1]), (gltf::LevelFilters{Data, Data, Data, Data}));
    EXPECT_EQ(levelFiltersOf(uses[2]), (gltf::LevelFilters{Color, Color, Color, Glossiness}));
    EXPECT_EQ(levelFiltersOf(uses[3]), (gltf::LevelFilters{Color, Color, Color, Data}));
    EXPECT_FALSE(blitsSuit(uses[0]));
    EXPECT_TRUE(blitsSuit(uses[1]));
    EXPECT_FALSE(blitsSuit(uses[2]));
}

// A smooth picture with values of its own in each channel.
gltf::Image smoothImage(int width, int height) {
    gltf::Image image;
    image.pointer = "/images/0";
    image.width = width;
    image.height = height;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const auto byte = [](double value) { return static_cast<std::uint8_t>(std::lround(value)); };
            image.pixels.insert(image.pixels.end(), {byte(255.0 * x / width), byte(255.0 * y / height),
                                                     byte(127.0 + 100.0 * std::sin(0.1 * (x + y))),
                                                     byte(200.0 - 100.0 * x / width)});
        }
    }
    return image;
}

class Packing : public ::testing::Test {
protected:
    void SetUp() override {
        if (!gltf::hasBasisu()) {
            GTEST_SKIP() << "this build does not pack blocks";
        }
    }
};

// The root of the mean square of the differences in the channels that the use reads.
double errorOf(const gltf::FittedImage& fitted, const std::vector<std::uint8_t>& pixels,
               std::uint32_t channels) {
    const auto blocks =
        static_cast<std::size_t>(bytesOfLevel(fitted.format, static_cast<std::uint32_t>(fitted.width),
                                              static_cast<std::uint32_t>(fitted.height), 0));
    const auto decoded =
        gltf::decodeBlocks(fitted.format, false, static_cast<std::uint32_t>(fitted.width),
                           static_cast<std::uint32_t>(fitted.height), std::span(fitted.texels).first(blocks));
    EXPECT_TRUE(decoded);
    double sum = 0.0;
    int count = 0;
    for (std::size_t i = 0; decoded && i < pixels.size(); ++i) {
        const std::size_t channel = i % 4;
        if ((channels >> channel & 1U) != 0) {
            const auto stored = static_cast<std::size_t>(fitted.channels[channel]);
            const double difference = static_cast<double>((*decoded)[i - channel + stored]) - pixels[i];
            sum += difference * difference;
            ++count;
        }
    }
    return std::sqrt(sum / count);
}

TEST_F(Packing, KeepsTheChannelsThatAreRead) {
    const gltf::Image image = smoothImage(62, 33);
    const gltf::Scene scene;
    struct Row {
        gltf::ImageUse use;
        TexelFormat format;
    };
    for (const Row& row : {Row{{true, false, false, false, 15}, TexelFormat::Bc7},
                           Row{{false, true, true, false, 7}, TexelFormat::Bc5},
                           Row{{false, true, false, false, 6}, TexelFormat::Bc5},
                           Row{{false, true, false, false, 2}, TexelFormat::Bc4},
                           Row{{false, true, false, false, 8}, TexelFormat::Bc4}}) {
        SCOPED_TRACE(testing::Message() << infoOf(row.format).name << ", channels " << row.use.channels);
        const auto fitted = must(
            fitImage(scene, image, row.use, {.formats = kDesktop, .compress = true, .decodeEmission = true}));
        EXPECT_EQ(fitted.format, row.format);
        EXPECT_EQ(fitted.levels, 6);
        EXPECT_EQ(fitted.texels.size(), bytesOfLevels(row.format, 62, 33, 6));
        EXPECT_TRUE(fitted.decoded.empty());
        EXPECT_LT(errorOf(fitted, image.pixels, row.use.isNormals ? 3 : row.use.channels),
                  row.format == TexelFormat::Bc7 ? 3.5 : 1.7);
    }
    const gltf::ImageUse emission{true, false, false, true, 7};
    const auto fitted =
        fitImage(scene, image, emission, {.formats = kDesktop, .compress = true, .decodeEmission = true});
    ASSERT_TRUE(fitted.ok());
    EXPECT_EQ(fitted->decoded, image.pixels);
}

TEST_F(Packing, OpaqueTexelsStayOpaque) {
    gltf::Image image = smoothImage(64, 64);
    for (std::size_t i = 3; i < image.pixels.size(); i += 4) {
        image.pixels[i] = 255;
    }
    const gltf::ImageUse use{true, false, false, false, 15};
    const auto fitted = fitImage(gltf::Scene(), image, use, {.formats = kDesktop, .compress = true});
    ASSERT_TRUE(fitted.ok());
    const auto decoded =
        gltf::decodeBlocks(fitted->format, false, 64, 64, std::span(fitted->texels).first(64 * 64));
    ASSERT_TRUE(decoded);
    for (std::size_t i = 3; i < decoded->size(); i += 4) {
        ASSERT_EQ((*decoded)[i], 255);
    }
}

TEST(Fit, UncompressedImagesGetLevelsWhereBlitsWouldBeWrong) {
    const gltf::Scene scene;
    const gltf::FitOptions options{.formats = kDesktop};
    const auto levelsOf = [&](int width, int height, const gltf::ImageUse& use, bool all) {
        gltf::FitOptions wanted = options;
        wanted.allLevels = all;
        const auto fitted = fitImage(scene, smoothImage(width, height), use, wanted);
        EXPECT_TRUE(fitted.ok());
        EXPECT_EQ(fitted->format, TexelFormat::Rgba8);
        return fitted->levels;
    };
    const gltf::ImageUse color{true, false, false, false, 15};
    const gltf::ImageUse normals{false, true, true, false, 7};
    EXPECT_EQ(levelsOf(16, 8, color, false), 1);
    EXPECT_EQ(levelsOf(16, 8, color, true), 5);
    EXPECT_EQ(levelsOf(16, 8, normals, false), 5);
    EXPECT_EQ(levelsOf(16, 8, {.isData = true, .channels = 2, .roughness = 2}, false), 5);
    EXPECT_EQ(levelsOf(16, 8, {.isData = true, .channels = 2}, false), 1);
    EXPECT_EQ(levelsOf(15, 8, color, false), 4);
}

// A file in a block format goes up as it is if the device has the format for each use, and is unpacked if
// not.
TEST(Fit, BlocksOfFilesStay) {
    gltf::Scene scene;
    scene.path = "scene.gltf";
    gltf::Image image;
    image.pointer = "/images/0";
    image.width = 16;
    image.height = 8;
    image.levels = 5;
    const base::Bytes blocks = randomBlocks(TexelFormat::Bc3, 16, 8, 5);
    image.file = makeDds(16, 8, 5, "DXT5", 0, blocks);
    const gltf::ImageUse color{true, false, false, false, 15};
    const auto fitted = must(fitImage(scene, image, color, {.formats = kDesktop}));
    EXPECT_EQ(fitted.format, TexelFormat::Bc3);
    EXPECT_EQ(fitted.levels, 5);
    EXPECT_EQ(fitted.texels, blocks);
    const auto unpacked = fitImage(scene, image, color, {.formats = kMobile});
    ASSERT_TRUE(unpacked.ok());
    EXPECT_EQ(unpacked->format, TexelFormat::Rgba8);
    EXPECT_EQ(unpacked->levels, 5);
    EXPECT_EQ(unpacked->texels.size(), bytesOfLevels(TexelFormat::Rgba8, 16, 8, 5));
    // Levels of the file are not made again for roughness.
    const gltf::ImageUse roughness{.isData = true, .channels = 2, .roughness = 2};
    const auto asData = fitImage(scene, image, {.isData = true, .channels = 2}, {.formats = kMobile});
    const auto asRoughness = fitImage(scene, image, roughness, {.formats = kMobile});
    ASSERT_TRUE(asData.ok() && asRoughness.ok());
    EXPECT_EQ(asRoughness->texels, asData->texels);
    EXPECT_EQ(fitImage(scene, image, roughness, {.formats = kDesktop})->texels, blocks);
    // BC4 has no sRGB.
    image.levels = 1;
    image.file = makeDds(16, 8, 1, "ATI1", 0, randomBlocks(TexelFormat::Bc4, 16, 8, 1));
    const auto gray = fitImage(scene, image, color, {.formats = kDesktop});
    ASSERT_TRUE(gray.ok());
    EXPECT_EQ(gray->format, TexelFormat::Rgba8);
}

TEST_F(Packing, LevelsThatAFileLacksArePacked) {
    gltf::Image image;
    image.pointer = "/images/0";
    image.width = 16;
    image.height = 16;
    const gltf::ImageUse color{true, false, false, false, 15};
    const auto first =
        fitImage(gltf::Scene(), smoothImage(16, 16), color, {.formats = kDesktop, .compress = true});
    ASSERT_TRUE(first.ok());
    image.file = makeDds(16, 16, 1, "", 99, base::Bytes(first->texels.begin(), first->texels.begin() + 256));
    const auto fitted = must(fitImage(gltf::Scene(), image, color, {.formats = kDesktop}));
    EXPECT_EQ(fitted.format, TexelFormat::Bc7);
    EXPECT_EQ(fitted.levels, 5);
    ASSERT_EQ(fitted.texels.size(), bytesOfLevels(TexelFormat::Bc7, 16, 16, 5));
    EXPECT_TRUE(std::equal(first->texels.begin(), first->texels.begin() + 256, fitted.texels.begin()));
}

// ETC1S and UASTC become what the device has, close to what they are unpacked to.
TEST_F(Packing, BasisDataAreTranscoded) {
    struct Row {
        const char* file;
        gltf::ImageUse use;
        TexelFormats formats;
        TexelFormat format;
        double error;
    };
    const gltf::ImageUse color{true, false, false, false, 15};
    const gltf::ImageUse normals{false, true, true, false, 7};
    const gltf::ImageUse one{false, true, false, false, 2};
    using enum TexelFormat;
    const std::vector<Row> rows{
        {"uastc_alpha_zstd", color, kDesktop, Bc7, 1.5},
        {"uastc_alpha_zstd", color, kMobile, Astc4x4, 1.5},
        {"uastc_linear", normals, kDesktop, Bc5, 1.5},
        {"uastc_linear", one, kDesktop, Bc4, 1.5},
        {"etc1s", color, kDesktop, Bc7, 3.0},
        {"etc1s_alpha_mips", color, kDesktop, Bc7, 3.0},
        {"etc1s", color, formatsOf({Bc1}), Bc1, 6.0},
        {"etc1s_alpha_mips", color, formatsOf({Bc3}), Bc3, 6.0},
        {"etc1s", normals, kMobile, Astc4x4, 6.0},
    };
    for (const Row& row : rows) {
        SCOPED_TRACE(testing::Message() << row.file << " to " << infoOf(row.format).name);
        const auto bytes = base::readFile(std::filesystem::path(GLINT_SOURCE_DIR) / "tests/unit/gltf/ktx2" /
                                          (std::string(row.file) + ".ktx2"));
        ASSERT_TRUE(bytes.ok());
        gltf::Image image;
        image.pointer = "/images/0";
        image.width = 16;
        image.height = 8;
        image.levels = std::string(row.file) == "etc1s_alpha_mips" ? 5 : 1;
        image.file = *bytes;
        gltf::Scene scene;
        const auto fitted = must(fitImage(scene, image, row.use, {.formats = row.formats}));
        EXPECT_EQ(fitted.format, row.format);
        const auto decoded = fitImage(scene, image, row.use, {.formats = formatsOf({})});
        ASSERT_TRUE(decoded.ok());
        const std::vector<std::uint8_t> pixels(decoded->texels.begin(), decoded->texels.begin() + 4 * 16 * 8);
        const std::uint32_t channels = row.use.isNormals ? 3 : row.use.channels;
        EXPECT_LT(errorOf(fitted, pixels, channels), row.error);
    }
}

}  // namespace
}  // namespace glint::test
