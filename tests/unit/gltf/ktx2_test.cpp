// Tests KTX2 images (KHR_texture_basisu): which are decoded, which are refused and why, and which source of a
// texture is used. ktx2/make.py made the files.
#include "gltf/codecs/codecs.h"
#include "support/must.h"
#include "unit/gltf/block_files.h"
#include "unit/gltf/gltf_builder.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <functional>
#include <random>
#include <string>
#include <vector>

namespace glint::test {
namespace {

const gltf::ImportOptions kDecodeKtx2{.decodeImages = true};
constexpr std::size_t kLevelIndex = 80;

base::Bytes readKtx2File(const std::string& name) {
    return must(
        base::readFile(std::filesystem::path(GLINT_SOURCE_DIR) / "tests/unit/gltf/ktx2" / (name + ".ktx2")));
}

// Returns a scene whose base colour is that KTX2 image, without a fallback.
GltfBuilder basisuScene(const base::Bytes& bytes) {
    GltfBuilder builder = sceneWithImage(bytes, "image/ktx2");
    builder.root["extensionsUsed"] = Json::array({"KHR_texture_basisu"});
    Json texture;
    texture["extensions"]["KHR_texture_basisu"]["source"] = 0;
    builder.root["textures"][0] = std::move(texture);
    return builder;
}

std::size_t wordAt(const base::Bytes& bytes, std::size_t offset) {
    return bytes.at(offset) | std::size_t{bytes.at(offset + 1)} << 8U;
}

// Returns the pixel of a level.
std::array<int, 4> pixelAt(const gltf::Image& image, int level, int x, int y) {
    std::size_t offset = 0;
    for (int i = 0; i < level; ++i) {
        offset += 4 * pixelCount(image, i);
    }
    offset += 4 * static_cast<std::size_t>(y * std::max(image.width >> level, 1) + x);
    return {image.pixels.at(offset), image.pixels.at(offset + 1), image.pixels.at(offset + 2),
            image.pixels.at(offset + 3)};
}

// Expects every channel to be within the tolerance.
::testing::AssertionResult isNearPixel(const std::array<int, 4>& pixel, const std::array<int, 4>& expected,
                                       int tolerance) {
    for (std::size_t channel = 0; channel < 4; ++channel) {
        if (std::abs(pixel[channel] - expected[channel]) > tolerance) {
            return ::testing::AssertionFailure()
                   << pixel[0] << ' ' << pixel[1] << ' ' << pixel[2] << ' ' << pixel[3] << " is not "
                   << expected[0] << ' ' << expected[1] << ' ' << expected[2] << ' ' << expected[3];
        }
    }
    return ::testing::AssertionSuccess();
}

// Tests of pixels need the transcoder. Other tests run in every build.
class GltfKtx2 : public ::testing::Test {
protected:
    void SetUp() override {
        if (!gltf::hasBasisu()) {
            GTEST_SKIP() << "this build does not decode KTX2";
        }
    }

    static gltf::Image decode(const std::string& name) {
        GltfBuilder builder = basisuScene(readKtx2File(name));
        builder.root["extensionsRequired"] = builder.root["extensionsUsed"];
        const Result<gltf::Scene> scene = import(builder, kDecodeKtx2);
        if (!scene || scene->images.size() != 1) {
            ADD_FAILURE() << name << ": " << (scene ? "no image" : toString(scene.error()));
            return {};
        }
        EXPECT_EQ(readingWarnings(*scene).size(), name == "uastc_linear" ? 1U : 0U) << name;
        return scene->images[0];
    }
};

// The picture has four areas of one colour each. ETC1S keeps 5 bits of a colour and one of 8 steps of light
// around it.
TEST_F(GltfKtx2, DecodesEveryKindOfData) {
    struct Kind {
        const char* name;
        bool alpha;
        int levels;
        int tolerance;
        gltf::Transfer transfer;
    };
    for (const Kind& kind : {Kind{"etc1s", false, 1, 12, gltf::Transfer::Srgb},
                             Kind{"etc1s_alpha_mips", true, 5, 12, gltf::Transfer::Srgb},
                             Kind{"uastc_linear", false, 1, 3, gltf::Transfer::Linear},
                             Kind{"uastc_alpha_zstd", true, 1, 3, gltf::Transfer::Srgb}}) {
        SCOPED_TRACE(kind.name);
        const gltf::Image image = decode(kind.name);
        ASSERT_EQ(image.width, 16);
        ASSERT_EQ(image.height, 8);
        ASSERT_EQ(image.levels, kind.levels);
        ASSERT_EQ(image.pixels.size(), byteCount(image));
        EXPECT_EQ(image.transfer, kind.transfer);
        const int right = kind.alpha ? 96 : 255;
        EXPECT_TRUE(isNearPixel(pixelAt(image, 0, 1, 1), {200, 24, 24, 255}, kind.tolerance));
        EXPECT_TRUE(isNearPixel(pixelAt(image, 0, 14, 1), {24, 160, 40, right}, kind.tolerance));
        EXPECT_TRUE(isNearPixel(pixelAt(image, 0, 1, 6), {32, 48, 208, 255}, kind.tolerance));
        EXPECT_TRUE(isNearPixel(pixelAt(image, 0, 14, 6), {240, 232, 224, right}, kind.tolerance));
    }
}

// Buffer views may start at any byte. The transcoder reads structures, whose alignment builds with sanitizers
// check.
TEST_F(GltfKtx2, MayLieAnywhereInABuffer) {
    for (const std::size_t padding : {std::size_t{1}, std::size_t{6}}) {
        const base::Bytes bytes = readKtx2File("uastc_linear");
        GltfBuilder builder = basisuScene(bytes);
        builder.root["bufferViews"][0]["byteOffset"] = padding;
        builder.buffer.insert(builder.buffer.begin(), padding, std::uint8_t{0});
        const gltf::Scene scene = must(import(builder, kDecodeKtx2));
        EXPECT_TRUE(isNearPixel(pixelAt(scene.images[0], 0, 1, 1), {200, 24, 24, 255}, 3));
    }
}

// Each mip of these files has a colour of its own.
TEST_F(GltfKtx2, KeepsTheMipsOfTheFile) {
    constexpr std::array<std::array<int, 4>, 5> kSteps{
        {{224, 0, 0, 255}, {0, 224, 0, 255}, {0, 0, 224, 255}, {224, 224, 0, 255}, {0, 224, 224, 255}}};
    for (const char* name : {"etc1s_steps", "uastc_zstd_steps"}) {
        SCOPED_TRACE(name);
        const gltf::Image image = decode(name);
        ASSERT_EQ(image.levels, 5);
        ASSERT_EQ(image.pixels.size(), 4U * (256 + 64 + 16 + 4 + 1));
        for (int level = 0; level < image.levels; ++level) {
            const int last = (16 >> level) - 1;
            EXPECT_TRUE(
                isNearPixel(pixelAt(image, level, 0, 0), kSteps[static_cast<std::size_t>(level)], 12));
            EXPECT_TRUE(
                isNearPixel(pixelAt(image, level, last, last), kSteps[static_cast<std::size_t>(level)], 12));
        }
    }
}

TEST_F(GltfKtx2, IsPreferredToItsFallback) {
    GltfBuilder builder = basisuScene(readKtx2File("etc1s"));
    builder.append("images", {{"uri", std::string("data:image/png;base64,") + kPng8}});
    builder.root["textures"][0]["source"] = 1;
    const gltf::Scene scene = must(import(builder, kDecodeKtx2));
    ASSERT_EQ(scene.images.size(), 1U);
    EXPECT_EQ(scene.images[0].pointer, "/images/0");
    EXPECT_TRUE(readingWarnings(scene).empty());
}

// Damaged pixels behind a valid header are decoded or refused. The memory stays intact, which builds with
// AddressSanitizer check.
TEST_F(GltfKtx2, SurvivesDamage) {
    std::mt19937 random(7);
    int refused = 0;
    for (const char* name :
         {"etc1s_alpha_mips", "etc1s", "uastc_linear", "uastc_alpha_zstd", "uastc_zstd_steps"}) {
        const base::Bytes whole = readKtx2File(name);
        for (int round = 0; round < 200; ++round) {
            base::Bytes bytes = whole;
            for (int change = 0; change < 1 + round % 4; ++change) {
                bytes.at(12 + random() % (bytes.size() - 12)) = static_cast<std::uint8_t>(random());
            }
            if (round % 8 == 0) {
                bytes.resize(random() % bytes.size());
            }
            const Result<gltf::Scene> scene =
                import(basisuScene(bytes), {.decodeImages = true, .maxImageSize = 256});
            if (scene) {
                EXPECT_EQ(scene->images[0].pixels.size(), byteCount(scene->images[0]));
            } else {
                ++refused;
                EXPECT_TRUE(scene.error().id == "image-decode" || scene.error().id == "image-size")
                    << toString(scene.error());
            }
        }
    }
    EXPECT_GT(refused, 100);
}

// --- Headers, in every build ---

using Change = std::function<void(base::Bytes&)>;

// Returns why the header of the file is refused after a change, or "" if it is not.
std::string problemOf(const std::string& name, const Change& change) {
    base::Bytes bytes = readKtx2File(name);
    change(bytes);
    const auto file = gltf::readBlockFile(bytes);
    return file ? "" : file.error().message;
}

// These return the places of the data format descriptor and of the global data.
std::size_t descriptor(const base::Bytes& bytes) {
    return wordAt(bytes, 48);
}
std::size_t globalData(const base::Bytes& bytes) {
    return wordAt(bytes, 64);
}

TEST(GltfKtx2Header, IsRefusedWithTheReason) {
    struct Row {
        const char* file;
        Change change;
        const char* reason;
    };
    const std::vector<Row> rows{
        {"etc1s", [](base::Bytes& b) { b.resize(90); }, "ends within its header"},
        {"etc1s", [](base::Bytes& b) { setWord(b, 12, 97); }, "VkFormat 97"},   // R16G16B16A16_SFLOAT
        {"etc1s", [](base::Bytes& b) { setWord(b, 12, 145); }, "scheme is 1"},  // BC7
        {"uastc_hdr", [](base::Bytes&) {}, "VkFormat 1000066000"},
        {"etc1s", [](base::Bytes& b) { b.at(descriptor(b) + 12) = 168; }, "UASTC HDR"},
        {"etc1s", [](base::Bytes& b) { b.at(descriptor(b) + 12) = 169; }, "XUASTC"},
        {"etc1s", [](base::Bytes& b) { b.at(descriptor(b) + 12) = 1; }, "colour model 1"},
        {"etc1s", [](base::Bytes& b) { setWord(b, 20, 0); }, "0 x 8"},
        {"etc1s", [](base::Bytes& b) { setWord(b, 24, 0x80000000U); }, "16 x 2147483648"},
        {"etc1s", [](base::Bytes& b) { setWord(b, 28, 1); }, "3D image of Basis Universal"},
        {"etc1s", [](base::Bytes& b) { setWord(b, 32, 1000); }, "global data are damaged"},
        {"uastc_linear", [](base::Bytes& b) { setWord(b, 32, 2); }, "level 0 is damaged"},
        {"etc1s", [](base::Bytes& b) { setWord(b, 36, 6); }, "faces of the cube are not square"},
        {"etc1s", [](base::Bytes& b) { setWord(b, 36, 2); }, "a depth of 0, 0 layers and 2 faces"},
        {"etc1s", [](base::Bytes& b) { setWord(b, 40, 0); }, "0 levels"},
        {"etc1s", [](base::Bytes& b) { setWord(b, 40, 6); }, "6 levels; 1 to 5"},
        {"etc1s", [](base::Bytes& b) { setWord(b, 44, 2); }, "scheme is 2"},
        {"uastc_linear", [](base::Bytes& b) { setWord(b, 44, 1); }, "scheme is 1"},
        {"uastc_linear", [](base::Bytes& b) { setWord(b, 44, 3); }, "scheme is 3"},
        {"etc1s", [](base::Bytes& b) { setWord(b, 48, 0xFFFFFFF0U); }, "descriptor"},
        {"etc1s", [](base::Bytes& b) { setWord(b, 52, 40); }, "descriptor"},
        {"etc1s", [](base::Bytes& b) { setWord(b, descriptor(b), 60); }, "descriptor"},
        {"etc1s", [](base::Bytes& b) { b.at(descriptor(b) + 14) = 4; }, "transfer function"},
        {"etc1s_alpha_mips", [](base::Bytes& b) { b.at(descriptor(b) + 28 + 16 + 3) = 4; },
         "neither RGB nor RGBA"},
        {"uastc_linear", [](base::Bytes& b) { b.at(descriptor(b) + 28 + 3) = 6; }, "neither RGB nor RGBA"},
        {"etc1s", [](base::Bytes& b) { setWord(b, 56, 0xFFFFFFFFU); }, "metadata"},
        {"etc1s", [](base::Bytes& b) { setWord(b, 60, 0xFFFFFFFFU); }, "metadata"},
        {"etc1s", [](base::Bytes& b) { setWord(b, wordAt(b, 56), 0xFFFFFFFFU); }, "metadata"},
        {"etc1s", [](base::Bytes& b) { setWord(b, 68, 1); }, "global data"},
        {"etc1s", [](base::Bytes& b) { setWord(b, 76, 0xFFFFFFFFU); }, "global data"},
        {"etc1s", [](base::Bytes& b) { setWord(b, 72, 30); }, "global data"},
        {"etc1s", [](base::Bytes& b) { setWord(b, globalData(b) + 4, 0xFFFFFFFFU); }, "global data"},
        {"etc1s", [](base::Bytes& b) { setWord(b, globalData(b) + 24, 1000); }, "level 0"},
        {"etc1s", [](base::Bytes& b) { setWord(b, globalData(b) + 28, 0); }, "level 0"},
        // The offset plus the length wraps.
        {"etc1s", [](base::Bytes& b) { std::fill_n(b.begin() + kLevelIndex, 8, std::uint8_t{0xFF}); },
         "level 0"},
        {"etc1s", [](base::Bytes& b) { setWord(b, kLevelIndex + 8, 1000); }, "level 0"},
        {"etc1s", [](base::Bytes& b) { setWord(b, kLevelIndex + 16, 4); }, "level 0"},
        // The Zstandard data claim to be larger than their blocks.
        {"uastc_zstd_steps", [](base::Bytes& b) { setWord(b, kLevelIndex + 24 + 16, 0x7FFFFFFFU); },
         "level 1"},
        {"uastc_linear", [](base::Bytes& b) { setWord(b, kLevelIndex + 8, 64); }, "level 0"},
        {"uastc_linear",
         [](base::Bytes& b) {
             b.push_back(0);
             setWord(b, kLevelIndex, static_cast<std::uint32_t>(wordAt(b, kLevelIndex) + 1));
         },
         "multiple of 16"},
    };
    for (const Row& row : rows) {
        EXPECT_NE(problemOf(row.file, row.change).find(row.reason), std::string::npos)
            << row.file << ", " << row.reason << ": " << problemOf(row.file, row.change);
    }
    for (const char* name :
         {"etc1s", "etc1s_alpha_mips", "etc1s_steps", "uastc_linear", "uastc_alpha_zstd"}) {
        EXPECT_EQ(problemOf(name, [](base::Bytes&) {}), "") << name;
    }
}

TEST(GltfKtx2Header, DeviationsAreTold) {
    const auto deviationsOf = [](const Change& change, const std::string& name = "etc1s") {
        base::Bytes bytes = readKtx2File(name);
        change(bytes);
        const auto file = gltf::readBlockFile(bytes);
        EXPECT_TRUE(file);
        return file && !file->deviations.empty() ? file->deviations[0] : std::string();
    };
    EXPECT_EQ(deviationsOf([](base::Bytes&) {}), "");
    EXPECT_NE(deviationsOf([](base::Bytes& b) { b.at(descriptor(b) + 15) = 1; }).find("premultiplied"),
              std::string::npos);
    EXPECT_NE(deviationsOf([](base::Bytes& b) { b.at(descriptor(b) + 13) = 10; }).find("primaries"),
              std::string::npos);
    EXPECT_NE(deviationsOf([](base::Bytes& b) { b.at(descriptor(b) + 28 + 3) = 3; }).find("gray"),
              std::string::npos);
    EXPECT_NE(deviationsOf([](base::Bytes& b) { setWord(b, 20, 15); }).find("multiples of 4"),
              std::string::npos);
    // The files have one pair, "KTXwriter". It is as long as these.
    const auto rename = [](const std::string& pair) {
        return [pair](base::Bytes& b) {
            std::copy(pair.begin(), pair.end(), b.begin() + static_cast<std::ptrdiff_t>(wordAt(b, 56) + 4));
        };
    };
    using namespace std::string_literals;
    EXPECT_EQ(deviationsOf(rename("KTXorientation\0rd\0"s)), "");
    EXPECT_NE(deviationsOf(rename("KTXorientation\0ru\0"s)).find("KTXorientation"), std::string::npos);
    EXPECT_EQ(deviationsOf(rename("KTXswizzle\0rgba\0"s)), "");
    EXPECT_NE(deviationsOf(rename("KTXswizzle\0rrrg\0"s)).find("KTXswizzle"), std::string::npos);
    EXPECT_NE(problemOf("etc1s", rename("KTXanimData\0"s)).find("video"), std::string::npos);
}

// The transfer function that a file declares should match its use.
TEST_F(GltfKtx2, OtherUseThanTheFileSaysIsAWarning) {
    const auto warningOf = [](const std::string& name, bool asColor) {
        GltfBuilder builder = basisuScene(readKtx2File(name));
        if (!asColor) {
            builder.root["materials"][0] = {{"normalTexture", {{"index", 0}}}};
        }
        const gltf::Scene scene = must(import(builder, kDecodeKtx2));
        return findWarning(scene, "ktx2-metadata").message;
    };
    EXPECT_EQ(warningOf("etc1s", true), "");
    EXPECT_EQ(warningOf("uastc_linear", false), "");
    EXPECT_NE(warningOf("etc1s", false).find("/images/0 says that it is colour in sRGB"), std::string::npos);
    EXPECT_NE(warningOf("uastc_linear", true).find("/images/0 says that it is linear data"),
              std::string::npos);
}

// --- Without the transcoder ---

TEST(GltfBasisu, WithoutTranscoderFallsBackOrIsAnError) {
    if (gltf::hasBasisu()) {
        GTEST_SKIP() << "this build decodes KTX2";
    }
    GltfBuilder builder = basisuScene(readKtx2File("etc1s"));
    const auto expectError = [&] {
        const Diagnostic scene = mustFail(import(builder, kDecodeKtx2));
        EXPECT_EQ(scene.id, "texture-basisu");
        EXPECT_TRUE(scene.where.ends_with("#/textures/0"));
        EXPECT_NE(scene.hint.find("scripts/setup.sh"), std::string::npos);
    };
    expectError();
    builder.append("images", {{"uri", std::string("data:image/png;base64,") + kPng8}});
    builder.root["textures"][0]["source"] = 1;
    builder.root["extensionsRequired"] = builder.root["extensionsUsed"];
    expectError();

    builder.root.erase("extensionsRequired");
    const gltf::Scene fallback = must(import(builder, kDecodeKtx2));
    ASSERT_EQ(fallback.images.size(), 1U);
    EXPECT_EQ(fallback.images[0].pointer, "/images/1");
    ASSERT_EQ(countWarnings(fallback, "texture-basisu"), 1U);
    EXPECT_EQ(findWarning(fallback, "texture-basisu").severity, Severity::Note);
}

TEST(GltfBasisu, ExplainsKtxInTheGuiseOfPng) {
    base::Bytes start = readKtx2File("etc1s");
    start.resize(100);
    const Diagnostic scene = mustFail(import(sceneWithImage(start), kDecodeKtx2));
    EXPECT_EQ(scene.id, "image-decode");
    EXPECT_NE(scene.message.find("KTX2"), std::string::npos) << scene.message;
}

}  // namespace
}  // namespace glint::test
