// Tests images in block formats: DDS (MSFT_texture_dds) and KTX2.

#include "gltf/codecs/codecs.h"
#include "support/must.h"
#include "unit/gltf/block_files.h"
#include "unit/gltf/gltf_builder.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

namespace glint::test {
namespace {

base::Bytes bc1File() {
    return makeDds(16, 8, 5, "DXT1", 0, randomBlocks(TexelFormat::Bc1, 16, 8, 5));
}

void expectRefusal(const base::Bytes& bytes, const std::string& reason) {
    const auto file = gltf::readBlockFile(bytes);
    ASSERT_FALSE(file) << reason;
    EXPECT_NE(file.error().message.find(reason), std::string::npos) << reason << ": " << file.error().message;
}

TEST(GltfDds, ReadsEachFormatByFourCcAndByDxgiFormat) {
    struct Row {
        const char* fourCc;
        std::uint32_t dxgi;
        TexelFormat format;
        gltf::Transfer transfer;
    };
    for (const Row& row : {Row{"DXT1", 0, TexelFormat::Bc1, gltf::Transfer::Unknown},
                           Row{"DXT3", 0, TexelFormat::Bc2, gltf::Transfer::Unknown},
                           Row{"DXT5", 0, TexelFormat::Bc3, gltf::Transfer::Unknown},
                           Row{"ATI1", 0, TexelFormat::Bc4, gltf::Transfer::Unknown},
                           Row{"BC4U", 0, TexelFormat::Bc4, gltf::Transfer::Unknown},
                           Row{"ATI2", 0, TexelFormat::Bc5, gltf::Transfer::Unknown},
                           Row{"BC5U", 0, TexelFormat::Bc5, gltf::Transfer::Unknown},
                           Row{"", 71, TexelFormat::Bc1, gltf::Transfer::Linear},
                           Row{"", 75, TexelFormat::Bc2, gltf::Transfer::Srgb},
                           Row{"", 78, TexelFormat::Bc3, gltf::Transfer::Srgb},
                           Row{"", 80, TexelFormat::Bc4, gltf::Transfer::Linear},
                           Row{"", 83, TexelFormat::Bc5, gltf::Transfer::Linear},
                           Row{"", 99, TexelFormat::Bc7, gltf::Transfer::Srgb}}) {
        SCOPED_TRACE(testing::Message() << row.fourCc << row.dxgi);
        const base::Bytes blocks = randomBlocks(row.format, 20, 10, 3);
        const base::Bytes bytes = makeDds(20, 10, 3, row.fourCc, row.dxgi, blocks);
        const auto file = gltf::readBlockFile(bytes);
        ASSERT_TRUE(file) << file.error().message;
        EXPECT_EQ(file->format, row.format);
        EXPECT_EQ(file->transfer, row.transfer);
        EXPECT_EQ(file->width, 20);
        EXPECT_EQ(file->height, 10);
        EXPECT_EQ(file->levels, 3);
        EXPECT_EQ(blocksOf(*file, bytes).value(), blocks);
    }
}

using Change = std::function<void(base::Bytes&)>;

TEST(GltfDds, IsRefusedWithTheReason) {
    struct Row {
        Change change;
        const char* reason;
    };
    const std::vector<Row> rows{
        {[](base::Bytes& b) { b.resize(100); }, "ends within its header"},
        {[](base::Bytes& b) { setWord(b, 4, 120); }, "header is damaged"},
        {[](base::Bytes& b) { setWord(b, 76, 0); }, "header is damaged"},
        {[](base::Bytes& b) { setWord(b, 80, 0x41); }, "without block compression"},
        {[](base::Bytes& b) { setWord(b, 84, 0x54455242); }, "FourCC 0x54455242"},
        {[](base::Bytes& b) { setWord(b, 112, 0x200); }, "depth, layers or faces"},
        {[](base::Bytes& b) { setWord(b, 112, 0x200000); }, "depth, layers or faces"},
        {[](base::Bytes& b) { setWord(b, 12, 0); }, "16 x 0"},
        {[](base::Bytes& b) { setWord(b, 16, 0x80000000U); }, "2147483648 x 8"},
        {[](base::Bytes& b) { setWord(b, 28, 6); }, "6 levels; 1 to 5"},
        {[](base::Bytes& b) { setWord(b, 16, 0x40000000U); }, "ends within its level 0"},
        {[](base::Bytes& b) { b.pop_back(); }, "ends within its level 4"},
        {[](base::Bytes& b) {
             setWord(b, 84, 0x30315844);  // "DX10"
             b.resize(140);
         },
         "ends within its header"},
        {[](base::Bytes& b) {
             setWord(b, 84, 0x30315844);
             setWord(b, 128, 95);  // BC6H
         },
         "DXGI_FORMAT 95"},
        {[](base::Bytes& b) {
             setWord(b, 84, 0x30315844);
             setWord(b, 128, 81);  // BC4, signed
         },
         "DXGI_FORMAT 81"},
        {[](base::Bytes& b) {
             setWord(b, 84, 0x30315844);
             setWord(b, 128, 71);
             setWord(b, 132, 4);
         },
         "depth, layers or faces"},
    };
    for (const Row& row : rows) {
        base::Bytes bytes = bc1File();
        row.change(bytes);
        expectRefusal(bytes, row.reason);
    }
    base::Bytes unchanged = bc1File();
    setWord(unchanged, 28, 0);  // no mips
    const auto file = gltf::readBlockFile(unchanged);
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->levels, 1);
}

// The numbers are those of VkFormat.
TEST(GltfKtx2Blocks, ReadsEachFormat) {
    struct Row {
        std::uint32_t vkFormat;
        TexelFormat format;
        gltf::Transfer transfer;
        bool hasAlpha;
    };
    for (const Row& row : {Row{131, TexelFormat::Bc1, gltf::Transfer::Linear, false},
                           Row{132, TexelFormat::Bc1, gltf::Transfer::Srgb, false},
                           Row{133, TexelFormat::Bc1, gltf::Transfer::Linear, true},
                           Row{138, TexelFormat::Bc3, gltf::Transfer::Srgb, true},
                           Row{139, TexelFormat::Bc4, gltf::Transfer::Linear, true},
                           Row{141, TexelFormat::Bc5, gltf::Transfer::Linear, true},
                           Row{146, TexelFormat::Bc7, gltf::Transfer::Srgb, true},
                           Row{147, TexelFormat::Etc2Rgb, gltf::Transfer::Linear, true},
                           Row{155, TexelFormat::EacRg, gltf::Transfer::Linear, true},
                           Row{158, TexelFormat::Astc4x4, gltf::Transfer::Srgb, true},
                           Row{165, TexelFormat::Astc6x6, gltf::Transfer::Linear, true},
                           Row{184, TexelFormat::Astc12x12, gltf::Transfer::Srgb, true}}) {
        SCOPED_TRACE(row.vkFormat);
        const base::Bytes blocks = randomBlocks(row.format, 20, 10, 5);
        const base::Bytes bytes = makeKtx2(row.vkFormat, row.format, 20, 10, 5, blocks);
        const auto file = gltf::readBlockFile(bytes);
        ASSERT_TRUE(file) << file.error().message;
        EXPECT_EQ(file->format, row.format);
        EXPECT_EQ(file->transfer, row.transfer);
        EXPECT_EQ(file->hasAlpha, row.hasAlpha);
        EXPECT_EQ(file->deviations.size(), 1U);
        EXPECT_EQ(blocksOf(*file, bytes).value(), blocks);
    }
    // Signed values, BC6H, and floats.
    for (const std::uint32_t vkFormat : {140U, 142U, 143U, 154U, 97U}) {
        const base::Bytes bytes =
            makeKtx2(vkFormat, TexelFormat::Bc4, 4, 4, 1, randomBlocks(TexelFormat::Bc4, 4, 4, 1));
        expectRefusal(bytes, "VkFormat " + std::to_string(vkFormat));
    }
}

TEST(GltfKtx2Blocks, DamageIsRefused) {
    const base::Bytes whole =
        makeKtx2(145, TexelFormat::Bc7, 8, 8, 2, randomBlocks(TexelFormat::Bc7, 8, 8, 2));
    struct Row {
        std::size_t offset;
        std::uint32_t value;
        const char* reason;
    };
    for (const Row& row : {Row{44, 1, "scheme is 1"}, Row{44, 3, "scheme is 3"}, Row{52, 16, "descriptor"},
                           Row{80, 0xFFFFFFF0U, "level 0"}, Row{88, 48, "level 0"}, Row{96, 48, "level 0"},
                           Row{104, 4, "level 1"}, Row{112, 0, "level 1"}}) {
        base::Bytes bytes = whole;
        setWord(bytes, row.offset, row.value);
        SCOPED_TRACE(row.offset);
        expectRefusal(bytes, row.reason);
    }
    // What claims to be Zstandard data is unpacked, and found not to be.
    if (gltf::hasBasisu()) {
        base::Bytes bytes = whole;
        setWord(bytes, 44, 2);
        const auto file = gltf::readBlockFile(bytes);
        ASSERT_TRUE(file) << file.error().message;
        const Diagnostic blocks = mustFail(blocksOf(*file, bytes));
        EXPECT_NE(blocks.message.find("level 0"), std::string::npos) << blocks.message;
    }
}

// Blocks by hand, with the texels that the specification gives them.
TEST(GltfBlockDecode, KnownBlocks) {
    struct Row {
        TexelFormat format;
        base::Bytes block;
        std::size_t texel;
        std::array<int, 4> expected;
    };
    const std::vector<Row> rows{
        // Red and blue ends; the first texels have the indices 0, 1, 2, 3.
        {TexelFormat::Bc1, {0x00, 0xF8, 0x1F, 0x00, 0xE4, 0, 0, 0}, 0, {255, 0, 0, 255}},
        {TexelFormat::Bc1, {0x00, 0xF8, 0x1F, 0x00, 0xE4, 0, 0, 0}, 1, {0, 0, 255, 255}},
        {TexelFormat::Bc1, {0x00, 0xF8, 0x1F, 0x00, 0xE4, 0, 0, 0}, 2, {170, 0, 85, 255}},
        // With the ends in the other order index 3 is transparent.
        {TexelFormat::Bc1, {0x1F, 0x00, 0x00, 0xF8, 0xE4, 0, 0, 0}, 2, {127, 0, 127, 255}},
        {TexelFormat::Bc1, {0x1F, 0x00, 0x00, 0xF8, 0xE4, 0, 0, 0}, 3, {0, 0, 0, 0}},
        // Ends 200 and 60: index 2 is (6 * 200 + 60) / 7.
        {TexelFormat::Bc4, {200, 60, 0x02, 0, 0, 0, 0, 0}, 0, {180, 0, 0, 255}},
        // Ends 60 and 200: index 7 is 255, index 2 is (4 * 60 + 200) / 5.
        {TexelFormat::Bc4, {60, 200, 0x17, 0, 0, 0, 0, 0}, 0, {255, 0, 0, 255}},
        {TexelFormat::Bc4, {60, 200, 0x17, 0, 0, 0, 0, 0}, 1, {88, 0, 0, 255}},
        // ETC1, individual mode: both halves 0x8, table 0, all indices 0: +2.
        {TexelFormat::Etc2Rgb, {0x88, 0x88, 0x88, 0x00, 0, 0, 0, 0}, 5, {138, 138, 138, 255}},
        // EAC with multiplier 1 and table 0: the first pixel has index 7, +14.
        {TexelFormat::EacR, {100, 0x10, 0xE0, 0, 0, 0, 0, 0}, 0, {114, 0, 0, 255}},
    };
    for (const Row& row : rows) {
        const auto texels = gltf::decodeBlocks(row.format, false, 4, 4, row.block);
        ASSERT_TRUE(texels) << texels.error().message;
        for (std::size_t channel = 0; channel < 4; ++channel) {
            EXPECT_NEAR(texels.value().at(4 * row.texel + channel), row.expected[channel], 1)
                << infoOf(row.format).name << ", texel " << row.texel << ", channel " << channel;
        }
    }
}

// A scene whose base colour is that file.
GltfBuilder ddsScene(const base::Bytes& bytes) {
    GltfBuilder builder = sceneWithImage(bytes, "image/vnd-ms.dds");
    builder.root["extensionsUsed"] = Json::array({"MSFT_texture_dds"});
    builder.root["extensionsRequired"] = builder.root["extensionsUsed"];
    Json texture;
    texture["extensions"]["MSFT_texture_dds"]["source"] = 0;
    builder.root["textures"][0] = std::move(texture);
    return builder;
}

TEST(GltfDds, IsASourceOfATexture) {
    const base::Bytes blocks = randomBlocks(TexelFormat::Bc1, 16, 8, 5);
    const GltfBuilder builder = ddsScene(bc1File());
    const gltf::Scene decoded = must(import(builder, {.decodeImages = true}));
    ASSERT_EQ(decoded.images.size(), 1U);
    EXPECT_EQ(decoded.images[0].levels, 5);
    EXPECT_EQ(decoded.images[0].pixels.size(), byteCount(decoded.images[0]));
    const auto first =
        gltf::decodeBlocks(TexelFormat::Bc1, false, 16, 8, base::Bytes(blocks.begin(), blocks.begin() + 64));
    ASSERT_TRUE(first);
    EXPECT_TRUE(std::equal(first->begin(), first->end(), decoded.images[0].pixels.begin()));
    const gltf::Scene kept = must(import(builder, {.keepImageFiles = true}));
    EXPECT_EQ(kept.images[0].file, bc1File());
    EXPECT_TRUE(kept.images[0].pixels.empty());
    EXPECT_EQ(kept.images[0].width, 16);
    base::Bytes damaged = bc1File();
    damaged.resize(130);
    const Diagnostic refused = mustFail(import(ddsScene(damaged), {.keepImageFiles = true}));
    EXPECT_EQ(refused.id, "image-decode");
    EXPECT_NE(refused.message.find("DDS"), std::string::npos) << refused.message;
}

}  // namespace
}  // namespace glint::test
