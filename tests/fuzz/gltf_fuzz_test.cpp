// Damaged glTF files: truncated, with bytes flipped, numbers replaced and pieces repeated. Deterministic.
// Each import must return, with a scene or with a diagnostic; sanitizers see the rest.
#include "gltf/import.h"
#include "unit/gltf/gltf_builder.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace glint::test {
namespace {

constexpr std::uint32_t kSeed = 20240229;
constexpr int kMutationsPerFile = 1500;
constexpr int kContentMutations = 8000;

using Random = std::mt19937;

std::size_t below(Random& random, std::size_t limit) {
    return limit == 0 ? 0 : random() % limit;
}

// A scene with something of everything that the importer reads.
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

// Numbers on the edges of what the importer's arithmetic has to stand.
std::string hostileNumber(Random& random) {
    constexpr std::array kNumbers{"-1",
                                  "0",
                                  "1",
                                  "3",
                                  "255",
                                  "65535",
                                  "2147483647",
                                  "2147483648",
                                  "4294967295",
                                  "1e38",
                                  "1e39",
                                  "-0.0",
                                  "0.5",
                                  "9007199254740991",
                                  "5121",
                                  "5126",
                                  "1e-45",
                                  "18446744073709551615",
                                  "99999999999999999999"};
    return kNumbers[below(random, kNumbers.size())];
}

void replaceNumber(Random& random, std::string& text) {
    const std::size_t first = text.find_first_of("0123456789", below(random, text.size()));
    if (first == std::string::npos) {
        return;
    }
    const std::size_t last = text.find_first_not_of("0123456789.eE+-", first);
    text.replace(first, (last == std::string::npos ? text.size() : last) - first, hostileNumber(random));
}

void flipBytes(Random& random, std::string& text) {
    for (std::size_t count = 1 + below(random, 4); count > 0 && !text.empty(); --count) {
        char& byte = text[below(random, text.size())];
        byte = static_cast<char>(byte ^ static_cast<char>(1U << below(random, 8)));
    }
}

void repeatPiece(Random& random, std::string& text) {
    const std::string piece = text.substr(below(random, text.size()), 1 + below(random, 40));
    text.insert(below(random, text.size()), piece);
}

std::string mutate(Random& random, std::string text) {
    for (std::size_t rounds = 1 + below(random, 3); rounds > 0; --rounds) {
        switch (below(random, 5)) {
            case 0:
                text.resize(below(random, text.size()));
                break;
            case 1:
                flipBytes(random, text);
                break;
            case 2:
                repeatPiece(random, text);
                break;
            default:
                replaceNumber(random, text);
        }
    }
    return text;
}

// Every value of a document, to pick from.
void collect(Json& value, std::vector<Json*>& values) {
    values.push_back(&value);
    if (value.is_structured()) {
        for (Json& element : value) {
            collect(element, values);
        }
    }
}

// Replaces one value of the document by a hostile number, by another of its values, or by nothing.
void mutateValue(Random& random, Json& root) {
    std::vector<Json*> values;
    collect(root, values);
    Json& target = *values[below(random, values.size())];
    const Json other = *values[below(random, values.size())];
    switch (below(random, 6)) {
        case 0:
            target = other;
            break;
        case 1:
            if (target.is_structured() && !target.empty()) {
                target.erase(
                    std::next(target.begin(), static_cast<std::ptrdiff_t>(below(random, target.size()))));
            }
            break;
        case 2:
            if (target.is_array() && !target.empty()) {
                target.push_back(target[below(random, target.size())]);
            }
            break;
        default:
            if (target.is_number()) {
                target = Json::parse(hostileNumber(random), nullptr, false);
            }
    }
}

// A GLB whose container is sound, with damage in its values or its binary chunk: it goes deeper.
std::string mutateContents(Random& random, const GltfBuilder& builder) {
    GltfBuilder copy = builder;
    copy.root["buffers"] = Json::array({{{"byteLength", copy.buffer.size()}}});
    for (std::size_t rounds = below(random, 4); rounds > 0; --rounds) {
        mutateValue(random, copy.root);
    }
    std::string binary(copy.buffer.begin(), copy.buffer.end());
    if (below(random, 2) == 0) {
        flipBytes(random, binary);
    }
    const std::string body = chunk(0x4E4F534A, copy.root.dump(), ' ') + chunk(0x004E4942, binary, '\0');
    return "glTF" + word(2) + word(static_cast<std::uint32_t>(body.size() + 12)) + body;
}

struct Tally {
    int imported = 0;
    int refused = 0;
    std::set<std::string> ids;  // of the refusals
};

void importMutation(const std::filesystem::path& path, const std::string& bytes, Tally& tally) {
    ASSERT_TRUE(writeFile(path, bytes).ok());
    const ImportOptions options{.decodeImages = true, .maxVertices = 1U << 16, .maxFileBytes = 1U << 24};
    const Result<Scene> scene = importScene(path, options);
    if (scene) {
        ++tally.imported;
        EXPECT_EQ(scene->path, path.string());
        return;
    }
    ++tally.refused;
    tally.ids.insert(scene.error().id);
    EXPECT_TRUE(scene.error().where.starts_with(path.string())) << toString(scene.error());
    EXPECT_FALSE(scene.error().id.empty());
    EXPECT_FALSE(scene.error().message.empty());
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
    // Mutations that all fail early, or all succeed, would test nothing.
    EXPECT_GT(tally.imported, 2000);
    EXPECT_GT(tally.refused, 2000);
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
