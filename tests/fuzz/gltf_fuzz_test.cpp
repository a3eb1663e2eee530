// Imports damaged glTF files: truncated, with bits flipped, numbers replaced and pieces repeated. The damage
// is deterministic. Each import must return a scene or a diagnostic; sanitizers check the rest.
#include "fuzz/mutations.h"
#include "support/nightly.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

namespace glint::test {
namespace {

// By day a quarter.
const int kMutationsPerFile = nightly() ? 1500 : 375;
const int kContentMutations = nightly() ? 8000 : 2000;

// Returns a scene that has something of everything that the importer reads.
GltfBuilder richScene() {
    GltfBuilder builder;
    builder.root["extensionsUsed"] = Json::array({"KHR_lights_punctual", "KHR_texture_transform"});
    builder.root["extensions"]["KHR_lights_punctual"]["lights"] =
        Json::parse(R"([{"type": "spot", "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.5}}])");
    builder.append("cameras",
                   Json::parse(R"({"type": "perspective", "perspective": {"yfov": 1, "znear": 1}})"));
    builder.append("images", {{"uri", std::string("data:image/png;base64,") + kPng8}});
    builder.append("samplers", {{"wrapS", 33071}, {"minFilter", 9987}});
    builder.append("textures", {{"source", 0}, {"sampler", 0}});
    builder.append("materials", Json::parse(R"({"pbrMetallicRoughness": {"metallicFactor": 0.5,
        "baseColorTexture": {"index": 0, "extensions": {"KHR_texture_transform": {"offset": [0.5, 0.5]}}}},
        "normalTexture": {"index": 0, "scale": 0.5}, "emissiveFactor": [1, 0, 0], "alphaMode": "MASK"})"));
    Json primitive{{"material", 0}, {"mode", 5}};
    primitive["attributes"]["POSITION"] =
        builder.addAccessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0.5F}, 3);
    primitive["attributes"]["NORMAL"] =
        builder.addAccessor<std::int8_t>({0, 0, 127, 0, 0, 127, 0, 0, 127, 0, 0, 127}, 3, true);
    primitive["attributes"]["TANGENT"] = builder.addAccessor<float>(std::vector<float>(16, 1.0F), 4);
    primitive["attributes"]["TEXCOORD_0"] =
        builder.addAccessor<std::uint16_t>({0, 0, 65535, 0, 0, 65535, 65535, 65535}, 2, true);
    primitive["attributes"]["COLOR_0"] =
        builder.addAccessor<std::uint8_t>(std::vector<std::uint8_t>(16, 255), 4, true);
    primitive["indices"] = builder.addAccessor<std::uint16_t>({0, 1, 2, 3, 2, 1}, 1);
    builder.addMesh(primitive);
    const std::array<std::uint16_t, 2> targets{1, 2};
    const std::array<float, 6> values{1, 2, 3, 4, 5, 6};
    builder.root["accessors"][0]["sparse"] = {
        {"count", 2},
        {"indices", {{"bufferView", builder.addView(targets.data(), 4)}, {"componentType", 5123}}},
        {"values", {{"bufferView", builder.addView(values.data(), 24)}}}};
    builder.append("nodes", Json::parse(R"({"camera": 0, "children": [0], "rotation": [0, 0, 0, 1],
        "extensions": {"KHR_lights_punctual": {"light": 0}}})"));
    builder.root["scenes"] = Json::parse(R"([{"nodes": [1]}])");
    builder.root["scene"] = 0;
    return builder;
}

TEST(GltfFuzz, DamagedFilesAreRefusedOrRead) {
    Random random(kSeed);
    std::printf("seed %u\n", kSeed);
    const TemporaryFolder folder;
    const std::filesystem::path path = folder.path() / "scene.gltf";
    const GltfBuilder rich = richScene();
    GltfBuilder small;
    small.addTriangle();

    Tally whole;
    for (const std::string& file : {rich.text(), rich.glb(), small.text(), small.glb()}) {
        importMutation(path, file, whole);
    }
    ASSERT_EQ(whole.imported, 4);

    Tally tally;
    for (const std::string& file : {rich.text(), rich.glb(), small.text(), small.glb()}) {
        for (int i = 0; i < kMutationsPerFile; ++i) {
            importMutation(path, mutate(random, file), tally);
        }
    }
    for (int i = 0; i < kContentMutations; ++i) {
        importMutation(path, mutateContents(random, rich), tally);
    }
    std::printf("%d imported, %d refused for %zu kinds of reason\n", tally.imported, tally.refused,
                tally.ids.size());
    // If all mutations failed early, or all succeeded, they would test nothing.
    EXPECT_GT(tally.imported, kContentMutations / 4);
    EXPECT_GT(tally.refused, kContentMutations / 4);
    EXPECT_GT(tally.ids.size(), 20U);
}

TEST(GltfFuzz, EveryTruncationOfAGlbIsRefused) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder.path() / "scene.glb";
    GltfBuilder small;
    small.addTriangle();
    const std::string whole = small.glb();
    Tally tally;
    for (std::size_t size = 0; size < whole.size(); ++size) {
        importMutation(path, whole.substr(0, size), tally);
    }
    EXPECT_EQ(tally.imported, 0);
    EXPECT_EQ(tally.refused, static_cast<int>(whole.size()));
}

}  // namespace
}  // namespace glint::test
