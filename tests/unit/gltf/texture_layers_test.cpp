// Tests KTX2 files with layers, faces and a depth: what is read of them, what a device gets, and that
// textures have the dimension of their declaration.
#include "base/files.h"
#include "gltf/codecs/codecs.h"
#include "gltf/import.h"
#include "gltf/texels/fit.h"
#include "materials/declarations.h"
#include "support/must.h"
#include "support/temporary_folder.h"
#include "unit/gltf/block_files.h"
#include "unit/gltf/gltf_builder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>
#include <vector>

namespace glint::test {
namespace {

using Dimension = package::TextureEntry::Dimension;
using gltf::ImageShape;

constexpr std::uint32_t kRgba8 = 37;  // numbers of VkFormat
constexpr std::uint32_t kBc1 = 133;

struct Kind {
    Ktx2Layers layers;
    ImageShape shape;
};
// 8 x 8 pixels with three levels.
const Kind kArray{{.layers = 3}, {8, 8, 3, Dimension::Array, 3}};
const Kind kCube{{.faces = 6}, {8, 8, 3, Dimension::Cube, 6}};
const Kind kVolume{{.depth = 4}, {8, 8, 3, Dimension::Volume, 4}};

// Returns bytes for all levels, all of them different within a level.
base::Bytes storedBytes(const ImageShape& shape, TexelFormat format, std::uint64_t channels = 4) {
    base::Bytes bytes;
    for (int level = 0; level < shape.levels; ++level) {
        const std::uint64_t here = levelBytes(shape, format, level) / 4 * channels;
        for (std::uint64_t i = 0; i < here; ++i) {
            bytes.push_back(static_cast<std::uint8_t>(37 * i + 101 * static_cast<std::uint64_t>(level)));
        }
    }
    return bytes;
}

base::Bytes fileOf(const Kind& kind, std::uint32_t vkFormat, TexelFormat format, const base::Bytes& stored) {
    return makeKtx2(vkFormat, format, 8, 8, static_cast<std::uint32_t>(kind.shape.levels), stored,
                    kind.layers);
}

gltf::Image imageOf(const base::Bytes& file) {
    gltf::Image image;
    image.pointer = "/images/0";
    EXPECT_TRUE(gltf::kBasisu.readHeader(file, image));
    image.file = file;
    return image;
}

base::Bytes basisFile(const std::string& name) {
    return must(
        base::readFile(std::filesystem::path(GLINT_SOURCE_DIR) / "tests/unit/gltf/ktx2" / (name + ".ktx2")));
}

TEST(TextureLayers, OfEachDimensionAreRead) {
    for (const Kind& kind : {kArray, kCube, kVolume}) {
        SCOPED_TRACE(static_cast<int>(kind.shape.dimension));
        const base::Bytes texels = storedBytes(kind.shape, TexelFormat::Rgba8);
        gltf::Image image = imageOf(fileOf(kind, kRgba8, TexelFormat::Rgba8, texels));
        EXPECT_EQ(static_cast<const ImageShape&>(image), kind.shape);
        EXPECT_EQ(image.storage, gltf::Storage::Texels);
        EXPECT_EQ(image.transfer, gltf::Transfer::Linear);
        ASSERT_TRUE(gltf::kBasisu.decode(image.file, image));
        EXPECT_EQ(image.pixels, texels);
        EXPECT_EQ(image.pixels.size(), byteCount(image));

        const base::Bytes blocks = storedBytes(kind.shape, TexelFormat::Bc1);
        gltf::Image packed = imageOf(fileOf(kind, kBc1, TexelFormat::Bc1, blocks));
        EXPECT_EQ(static_cast<const ImageShape&>(packed), kind.shape);
        const auto file = must(gltf::readBlockFile(packed.file));
        EXPECT_EQ(must(blocksOf(file, packed.file)), blocks);
        // KHR_texture_basisu says nothing of such files, which only packs read.
        EXPECT_TRUE(file.deviations.empty());
        ASSERT_TRUE(gltf::kBasisu.decode(packed.file, packed));
        ASSERT_EQ(packed.pixels.size(), byteCount(packed));
        // The second layer of the second level, which has one block.
        const std::size_t first = levelBytes(kind.shape, TexelFormat::Bc1, 0);
        const auto block = must(
            gltf::decodeBlocks(TexelFormat::Bc1, false, 4, 4, gltf::ByteView(blocks).subspan(first + 8, 8)));
        EXPECT_TRUE(
            std::equal(block.begin(), block.end(),
                       packed.pixels.begin() +
                           static_cast<std::ptrdiff_t>(4 * (pixelCount(kind.shape, 0) + std::size_t{16}))));
    }
}

TEST(TextureLayers, TexelsWithFewerChannelsAreReadAsShadersDo) {
    struct Row {
        std::uint32_t vkFormat;
        TexelFormat format;
        std::size_t channels;
        gltf::Transfer transfer;
    };
    for (const Row& row : {Row{9, TexelFormat::Rgba8, 1, gltf::Transfer::Linear},
                           Row{15, TexelFormat::Rgba8, 1, gltf::Transfer::Srgb},
                           Row{16, TexelFormat::Rgba8, 2, gltf::Transfer::Linear},
                           Row{29, TexelFormat::Rgba8, 3, gltf::Transfer::Srgb},
                           Row{43, TexelFormat::Rgba8, 4, gltf::Transfer::Srgb},
                           Row{70, TexelFormat::Rgba16, 1, gltf::Transfer::Linear},
                           Row{77, TexelFormat::Rgba16, 2, gltf::Transfer::Linear},
                           Row{84, TexelFormat::Rgba16, 3, gltf::Transfer::Linear},
                           Row{91, TexelFormat::Rgba16, 4, gltf::Transfer::Linear}}) {
        SCOPED_TRACE(row.vkFormat);
        const base::Bytes stored = storedBytes(kVolume.shape, row.format, row.channels);
        gltf::Image image = imageOf(fileOf(kVolume, row.vkFormat, row.format, stored));
        EXPECT_EQ(image.transfer, row.transfer);
        ASSERT_TRUE(gltf::kBasisu.decode(image.file, image));
        ASSERT_EQ(image.pixels.size(), byteCount(image));
        const std::size_t code = row.format == TexelFormat::Rgba16 ? 2 : 1;
        for (std::size_t i = 0; i < image.pixels.size(); ++i) {
            const std::size_t texel = i / (4 * code);
            const std::size_t channel = i / code % 4;
            const int expected = channel < row.channels ? stored[texel * row.channels * code + i % (4 * code)]
                                                        : (channel == 3 ? 255 : 0);
            ASSERT_EQ(image.pixels[i], expected) << i;
        }
    }
    // Numbers outside of [0, 1], and sRGB of 16 bits, which does not exist.
    for (const std::uint32_t vkFormat : {10U, 76U, 97U, 109U}) {
        const auto file = gltf::readBlockFile(
            fileOf(kVolume, vkFormat, TexelFormat::Rgba8, storedBytes(kVolume.shape, TexelFormat::Rgba8)));
        ASSERT_FALSE(file);
        EXPECT_NE(file.error().message.find("VkFormat " + std::to_string(vkFormat)), std::string::npos);
    }
}

TEST(TextureLayers, WhatNoTextureHasIsRefused) {
    const base::Bytes whole =
        fileOf(kArray, kRgba8, TexelFormat::Rgba8, storedBytes(kArray.shape, TexelFormat::Rgba8));
    struct Row {
        std::size_t offset;
        std::uint32_t value;
        const char* reason;
    };
    for (const Row& row :
         {Row{28, 3, "a depth of 3, 3 layers and 1 faces"}, Row{36, 6, "a depth of 0, 3 layers and 6 faces"},
          Row{36, 0, "3 layers and 0 faces"}, Row{32, 0x80000000U, "2147483648 layers or slices"},
          Row{32, 0x7FFFFFFFU, "level 0 is damaged"}, Row{32, 4, "level 0 is damaged"},
          Row{40, 5, "5 levels; 1 to 4"}}) {
        base::Bytes bytes = whole;
        setWord(bytes, row.offset, row.value);
        const auto file = gltf::readBlockFile(bytes);
        ASSERT_FALSE(file) << row.reason;
        EXPECT_NE(file.error().message.find(row.reason), std::string::npos) << file.error().message;
    }
    // The levels of a 3D image end where its depth does.
    const Kind deep{{.depth = 64}, {8, 8, 7, Dimension::Volume, 64}};
    EXPECT_EQ(static_cast<const ImageShape&>(imageOf(
                  fileOf(deep, kRgba8, TexelFormat::Rgba8, storedBytes(deep.shape, TexelFormat::Rgba8)))),
              deep.shape);
}

// Devices read layers of blocks as they are, and 3D images of BC. Others are unpacked.
TEST(TextureLayers, StayInBlocksWhereDevicesHaveThem) {
    TexelFormats desktop;
    desktop.add(TexelFormat::Bc1, false);
    TexelFormats mobile;
    mobile.add(TexelFormat::Etc2Rgb, false);
    const gltf::ImageUse data{false, true, false, false, 15};
    for (const Kind& kind : {kArray, kCube, kVolume}) {
        SCOPED_TRACE(static_cast<int>(kind.shape.dimension));
        const base::Bytes bc = storedBytes(kind.shape, TexelFormat::Bc1);
        const gltf::Image bcImage = imageOf(fileOf(kind, kBc1, TexelFormat::Bc1, bc));
        const auto fitted = must(fitImage({}, bcImage, data, {.formats = desktop}));
        EXPECT_EQ(fitted.format, TexelFormat::Bc1);
        EXPECT_TRUE(std::equal(bc.begin(), bc.end(), fitted.texels.begin()));
        EXPECT_EQ(static_cast<const ImageShape&>(fitted).layers, kind.shape.layers);
        const auto unpacked = must(fitImage({}, bcImage, data, {.formats = mobile}));
        EXPECT_EQ(unpacked.format, TexelFormat::Rgba8);
        EXPECT_EQ(unpacked.texels.size(), byteCount(bcImage));

        const gltf::Image etc =
            imageOf(fileOf(kind, 147, TexelFormat::Etc2Rgb, storedBytes(kind.shape, TexelFormat::Etc2Rgb)));
        EXPECT_EQ(must(fitImage({}, etc, data, {.formats = mobile})).format,
                  isVolume(kind.shape) ? TexelFormat::Rgba8 : TexelFormat::Etc2Rgb);
    }
}

// Levels are made of each layer by itself.
TEST(TextureLayers, GetLevelsOfTheirOwn) {
    gltf::Texels texels{{2, 2, 1, Dimension::Array, 2}, gltf::PixelFormat::Rgba8, {}};
    for (const int layer : {0, 1}) {
        for (int i = 0; i < 16; ++i) {
            texels.bytes.push_back(static_cast<std::uint8_t>(layer == 0 ? 10 * (i / 4) : 200));
        }
    }
    completeLevels(texels, gltf::filtersOf(gltf::LevelFilter::Data));
    EXPECT_EQ(texels.levels, 2);
    ASSERT_EQ(texels.bytes.size(), 2U * (16 + 4));
    EXPECT_EQ(texels.bytes[32], 15);
    EXPECT_EQ(texels.bytes[36], 200);
    if (!gltf::hasBasisu()) {
        return;
    }
    // Files in blocks have levels packed.
    Kind kind = kArray;
    kind.shape.levels = 1;
    base::Bytes blocks;
    for (const std::uint32_t color : {0xF800U, 0x07E0U, 0x001FU}) {  // red, green, blue in 5, 6 and 5 bits
        for (int i = 0; i < 4; ++i) {
            const auto low = static_cast<std::uint8_t>(color);
            const auto high = static_cast<std::uint8_t>(color >> 8U);
            blocks.insert(blocks.end(), {low, high, low, high, 0, 0, 0, 0});
        }
    }
    TexelFormats formats;
    formats.add(TexelFormat::Bc1, false);
    const auto fitted = must(fitImage({}, imageOf(fileOf(kind, kBc1, TexelFormat::Bc1, blocks)),
                                      {false, true, false, false, 15}, {.formats = formats}));
    ASSERT_EQ(fitted.levels, 4);
    ASSERT_EQ(fitted.texels.size(), 8U * 3 * (4 + 1 + 1 + 1));
    for (std::size_t i = 0; i < 9; ++i) {
        const auto block = must(gltf::decodeBlocks(TexelFormat::Bc1, false, 4, 4,
                                                   std::span(fitted.texels).subspan(8 * (12 + i), 8)));
        for (std::size_t channel = 0; channel < 3; ++channel) {
            EXPECT_NEAR(block[channel], i % 3 == channel ? 255 : 0, 8) << i << ' ' << channel;
        }
    }
}

// The four areas of the files lie in the blocks 0, 2, 4 and 6 of 8.
TEST(TextureLayers, OfBasisUniversalAreTranscoded) {
    if (!gltf::hasBasisu()) {
        GTEST_SKIP() << "this build does not decode KTX2";
    }
    constexpr std::array<std::array<int, 3>, 4> kAreas{
        {{200, 24, 24}, {24, 160, 40}, {32, 48, 208}, {240, 232, 224}}};
    const base::Bytes uastc = basisFile("uastc_linear");
    const std::size_t data = uastc.size() - 128;
    const auto faces = [&](const std::vector<int>& areas, bool isCube) {
        base::Bytes bytes(uastc.begin(), uastc.begin() + static_cast<std::ptrdiff_t>(data));
        for (const int area : areas) {
            const auto block =
                uastc.begin() + static_cast<std::ptrdiff_t>(data + 32 * static_cast<std::size_t>(area));
            bytes.insert(bytes.end(), block, block + 16);
        }
        setWord(bytes, 20, 4);
        setWord(bytes, 24, 4);
        const auto count = static_cast<std::uint32_t>(areas.size());
        setWord(bytes, isCube ? 36 : 32, count);
        setWord(bytes, 88, 16 * count);
        setWord(bytes, 96, 16 * count);
        return bytes;
    };
    TexelFormats formats;
    formats.add(TexelFormat::Bc7, true);
    for (const bool isCube : {false, true}) {
        const std::vector<int> areas = isCube ? std::vector{2, 0, 1, 3, 0, 1} : std::vector{3, 1, 0};
        gltf::Image image = imageOf(faces(areas, isCube));
        EXPECT_EQ(image.dimension, isCube ? Dimension::Cube : Dimension::Array);
        EXPECT_EQ(image.storage, gltf::Storage::Transcoded);
        const auto fitted = must(fitImage({}, image, {true, false, false, false, 15}, {.formats = formats}));
        EXPECT_EQ(fitted.format, TexelFormat::Bc7);
        ASSERT_TRUE(gltf::kBasisu.decode(image.file, image));
        for (std::size_t i = 0; i < areas.size(); ++i) {
            const auto block = must(gltf::decodeBlocks(TexelFormat::Bc7, false, 4, 4,
                                                       std::span(fitted.texels).subspan(16 * i, 16)));
            for (std::size_t channel = 0; channel < 3; ++channel) {
                const int expected = kAreas[static_cast<std::size_t>(areas[i])][channel];
                EXPECT_NEAR(block[channel], expected, 3);
                EXPECT_NEAR(image.pixels[64 * i + channel], expected, 3);
            }
        }
    }
    // ETC1S describes each layer. Both have the data of the file.
    base::Bytes etc1s = basisFile("etc1s");
    constexpr std::ptrdiff_t kGlobalData = 0xB8;
    const base::Bytes description(etc1s.begin() + kGlobalData + 20, etc1s.begin() + kGlobalData + 40);
    etc1s.insert(etc1s.begin() + kGlobalData + 40, description.begin(), description.end());
    setWord(etc1s, 32, 2);
    setWord(etc1s, 72, 0x8E + 20);
    setWord(etc1s, 80, 0x146 + 20);
    gltf::Image image = imageOf(etc1s);
    EXPECT_EQ(static_cast<const ImageShape&>(image), (ImageShape{16, 8, 1, Dimension::Array, 2}));
    ASSERT_TRUE(gltf::kBasisu.decode(image.file, image));
    ASSERT_EQ(image.pixels.size(), 4U * 16 * 8 * 2);
    for (const std::size_t layer : {std::size_t{0}, std::size_t{1}}) {
        EXPECT_NEAR(image.pixels[4 * 16 * 8 * layer], 200, 12);
    }
}

// ---- Materials ----

// A layer that reads a texture of each dimension.
const materials::MaterialModel& moodModel() {
    static const TemporaryFolder folder;
    static const Result<const materials::MaterialModel*> model = [&] {
        EXPECT_TRUE(base::writeFile(folder.path() / "mood.json", std::string(R"json({
            "name": "mood", "extension": "EXT_mood", "stage": "base",
            "replaces": {"object": "pbrMetallicRoughness"},
            "textures": [{"name": "wall"}, {"name": "pages", "dimension": "2d-array"},
                         {"name": "sky", "dimension": "cube"}, {"name": "fog", "dimension": "3d"}]})json")));
        return materials::loadMaterialModel(std::vector{folder.path().string()});
    }();
    EXPECT_TRUE(model) << toString(model.error());
    return **model;
}

base::Bytes textureFile(const std::string& slot) {
    const Kind& kind = slot == "pages" ? kArray : slot == "sky" ? kCube : kVolume;
    return slot == "wall"
               ? makeKtx2(kRgba8, TexelFormat::Rgba8, 8, 8, 1, randomBlocks(TexelFormat::Rgba8, 8, 8, 1))
               : fileOf(kind, kRgba8, TexelFormat::Rgba8, storedBytes(kind.shape, TexelFormat::Rgba8));
}

// Imports a list whose material has the file of `file` in `slot`.
Result<gltf::Scene> importList(const std::string& slot, const std::string& file,
                               gltf::ImportOptions options) {
    const TemporaryFolder folder;
    options.materialModel = &moodModel();
    EXPECT_TRUE(base::writeFile(folder.path() / "texture.ktx2", textureFile(file)));
    EXPECT_TRUE(
        base::writeFile(folder.path() / "list.json",
                        R"({"materialList": 1, "materials": [{"name": "a", "model": "mood", "textures": {")" +
                            slot + R"(": "texture.ktx2"}}]})"));
    return gltf::importScene(folder.path() / "list.json", options);
}

TEST(TextureLayers, MaterialsNameFilesOfTheDeclaredDimension) {
    const std::vector<std::pair<std::string, std::string>> slots{
        {"wall", "2D"}, {"pages", "2D with layers"}, {"sky", "a cube"}, {"fog", "3D"}};
    for (const auto& [slot, wanted] : slots) {
        for (const auto& [file, given] : slots) {
            SCOPED_TRACE(slot + " with " + file);
            for (const bool decodes : {false, true}) {
                const auto scene = importList(slot, file, {.decodeImages = decodes, .trustTextures = true});
                if (slot == file) {
                    ASSERT_TRUE(scene) << toString(scene.error());
                    EXPECT_EQ(scene->images.at(0).pixels.empty(), !decodes);
                    const gltf::Image read = imageOf(textureFile(file));
                    EXPECT_EQ(static_cast<const ImageShape&>(scene->images[0]), read);
                    continue;
                }
                const Diagnostic refused = mustFail(scene);
                EXPECT_EQ(refused.id, "texture-dimension");
                EXPECT_TRUE(refused.where.ends_with("#/materials/0/textures/" + slot)) << refused.where;
                EXPECT_EQ(refused.message, "the texture is declared as " + wanted +
                                               ", and /images/0 (texture.ktx2) is " + given);
            }
        }
    }
}

TEST(TextureLayers, ExtensionsOfPacksInGltfNameThem) {
    const base::Bytes bytes = textureFile("sky");
    GltfBuilder builder = sceneWithImage(bytes, "image/ktx2");
    builder.root["materials"][0] = {{"extensions", {{"EXT_mood", {{"sky", {{"index", 0}}}}}}}};
    gltf::ImportOptions options{.decodeImages = true};
    options.materialModel = &moodModel();
    const gltf::Scene scene = must(import(builder, options));
    ASSERT_EQ(scene.images.size(), 1U);
    EXPECT_EQ(scene.images[0].dimension, Dimension::Cube);
    EXPECT_TRUE(readingWarnings(scene).empty());
    // Nothing is known of what it holds.
    ASSERT_NE(scene.materials[0].textures.begin(), scene.materials[0].textures.end());
    EXPECT_TRUE(scene.materials[0].textures.begin()->second.content.image.empty());
}

}  // namespace
}  // namespace glint::test
