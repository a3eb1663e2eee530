// Damages compressed geometry and images, so that decoders see bytes that their encoders never wrote.
#include "fuzz/mutations.h"
#include "support/models.h"
#include "support/nightly.h"
#include "unit/gltf/packed_scenes.h"
#include "unit/gltf/png_writer.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace glint::test {
namespace {

namespace fs = std::filesystem;

// By day a third.
const int kMutationsPerScene = nightly() ? 1500 : 500;
const int kMutationsPerModel = nightly() ? 150 : 50;
const fs::path kModels = modelsFolder() / "features";

GltfBuilder widePngScene() {
    GltfBuilder builder;
    const base::Bytes png =
        makePng({4, 4, 16, PngColor::Rgba, {}, base::Bytes(std::size_t{4} * 4 * 8, 0x5A)});
    const int view = builder.addView(png.data(), png.size());
    builder.append("images", {{"bufferView", view}, {"mimeType", "image/png"}});
    builder.append("textures", {{"source", 0}});
    builder.append("materials", Json::parse(R"({"normalTexture": {"index": 0}})"));
    return builder;
}

// Returns a GLB with flipped bits in its binary chunk only, so that the JSON leads every import to the
// decoder.
std::string damageBinary(Random& random, const GltfBuilder& builder) {
    GltfBuilder copy = builder;
    std::string binary(copy.buffer.begin(), copy.buffer.end());
    flipBytes(random, binary);
    copy.buffer.assign(binary.begin(), binary.end());
    return copy.glb();
}

void expectBothOutcomes(const Tally& tally, const char* name) {
    std::printf("%s: %d imported, %d refused for %zu kinds of reason\n", name, tally.imported, tally.refused,
                tally.ids.size());
    // If all mutations failed, or all succeeded, they would test nothing.
    EXPECT_GT(tally.imported, 100) << name;
    EXPECT_GT(tally.refused, 100) << name;
}

TEST(PackedFuzz, DamagedDataIsRefusedOrRead) {
    const TemporaryFolder folder;
    const fs::path path = folder.path() / "scene.glb";
    const std::vector<std::pair<const char*, GltfBuilder>> scenes{
        {"Draco, sequential", dracoScene(DracoMethod::Sequential)},
        {"Draco, edgebreaker", dracoScene(DracoMethod::Edgebreaker)},
        {"meshopt", meshoptScene()},
        {"meshopt, version 1", meshoptV1Scene()},
        {"WebP", webpScene()},
        {"PNG of 16 bits", widePngScene()}};
    std::printf("seed %u\n", kSeed);
    for (const auto& [name, scene] : scenes) {
        Random random(kSeed);
        Tally whole;
        importMutation(path, scene.glb(), whole);
        ASSERT_EQ(whole.imported, 1) << name;
        Tally tally;
        for (int i = 0; i < kMutationsPerScene; ++i) {
            importMutation(path, damageBinary(random, scene), tally);
            importMutation(path, mutateContents(random, scene), tally);
        }
        expectBothOutcomes(tally, name);
    }
}

TEST(PackedFuzz, EveryTruncationOfPackedDataReturns) {
    const TemporaryFolder folder;
    const fs::path path = folder.path() / "scene.glb";
    for (const DracoMethod method : {DracoMethod::Sequential, DracoMethod::Edgebreaker}) {
        GltfBuilder scene = dracoScene(method);
        const auto size = scene.root["bufferViews"][0]["byteLength"].get<std::size_t>();
        Tally tally;
        for (std::size_t length = 0; length < size; ++length) {
            scene.root["bufferViews"][0]["byteLength"] = length;
            importMutation(path, scene.glb(), tally);
        }
        EXPECT_EQ(tally.imported, 0);
        EXPECT_EQ(tally.refused, static_cast<int>(size));
    }
}

// The file with the compressed data is damaged; the model's other files are copied unchanged.
TEST(PackedFuzz, DamagedModelsAreRefusedOrRead) {
    if (!fs::exists(kModels)) {
        GTEST_SKIP() << noModels(kModels);
    }
    const std::vector<std::array<const char*, 3>> models{
        {"Avocado-draco", "Avocado.gltf", "Avocado.bin"},
        {"pirate", "pirate.glb", "pirate.glb"},
        {"box-textured-separate-webp", "box-textured-separate.gltf", "cesium logo.webp"}};
    for (const auto& [folderName, scene, packed] : models) {
        const TemporaryFolder folder;
        fs::copy(kModels / folderName, folder.path(), fs::copy_options::recursive);
        const Result<base::Bytes> whole = base::readFile(folder.path() / packed);
        ASSERT_TRUE(whole.ok());
        const bool isImage = std::string_view(packed).ends_with(".webp");
        Random random(kSeed);
        int imported = 0;
        for (int i = 0; i < kMutationsPerModel; ++i) {
            std::string bytes(whole->begin(), whole->end());
            flipBytes(random, bytes);
            if (below(random, 4) == 0) {
                bytes.resize(below(random, bytes.size()));
            }
            ASSERT_TRUE(base::writeFile(folder.path() / packed, bytes).ok());
            const Result<gltf::Scene> result =
                gltf::importScene(folder.path() / scene, {.decodeImages = isImage});
            imported += result ? 1 : 0;
            EXPECT_TRUE(result.ok() || !result.error().message.empty());
        }
        std::printf("%s: %d of %d imported\n", folderName, imported, kMutationsPerModel);
        EXPECT_LT(imported, kMutationsPerModel);
    }
}

}  // namespace
}  // namespace glint::test
