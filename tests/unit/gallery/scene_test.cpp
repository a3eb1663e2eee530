// Tests the promises of the example scene: features, instances, lights, limits, the same bytes every time.
#include "scene.h"

#include "document.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>

namespace gallery::test {

namespace {

int countNodes(const std::function<bool(const Json&)>& matches) {
    const Json& nodes = document().json["nodes"];
    return static_cast<int>(std::count_if(nodes.begin(), nodes.end(), matches));
}

std::map<std::string, std::string> filesOf(const std::filesystem::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        files[entry.path().filename().string()] = readAll(entry.path());
    }
    return files;
}

std::uint32_t bigEndian(const std::string& bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t byte = 0; byte < 4; ++byte) {
        value = value << 8 | static_cast<std::uint8_t>(bytes.at(at + byte));
    }
    return value;
}

}  // namespace

TEST(GalleryScene, IsTheSameToTheByteEveryTime) {
    const TemporaryFolder again;
    ASSERT_TRUE(writeGallery(again.path()).ok());
    EXPECT_EQ(filesOf(again.path()), filesOf(document().folder));
}

TEST(GalleryScene, StaysWithinItsLimits) {
    std::size_t bytes = 0;
    for (const auto& [name, contents] : filesOf(document().folder)) {
        bytes += contents.size();
        if (name.ends_with(".png")) {
            // The header chunk has width and height in big-endian order.
            EXPECT_LE(bigEndian(contents, 16), 1024U) << name;
            EXPECT_LE(bigEndian(contents, 20), 1024U) << name;
        }
    }
    EXPECT_LE(bytes, 12'000'000U);
    std::size_t triangles = 0;
    for (const Json& node : document().json["nodes"]) {
        if (node.contains("mesh")) {
            for (const Json& primitive :
                 document().json["meshes"].at(node["mesh"].get<std::size_t>())["primitives"]) {
                triangles += document().accessor(primitive["indices"])["count"].get<std::size_t>() / 3;
            }
        }
    }
    EXPECT_LE(triangles, 150'000U);
    EXPECT_GE(document().json["materials"].size(), 45U);
}

TEST(GalleryScene, HasEveryKindOfInstance) {
    std::map<std::size_t, int> uses;
    for (const Json& node : document().json["nodes"]) {
        if (node.contains("mesh")) {
            ++uses[node["mesh"].get<std::size_t>()];
        }
    }
    EXPECT_TRUE(std::any_of(uses.begin(), uses.end(), [](const auto& use) { return use.second >= 4; }));
    const auto scaled = [](const std::function<bool(double, double, double)>& matches) {
        return [matches](const Json& node) {
            return node.contains("scale") && node.contains("mesh") &&
                   matches(node["scale"][0].get<double>(), node["scale"][1].get<double>(),
                           node["scale"][2].get<double>());
        };
    };
    EXPECT_GE(countNodes(scaled([](double x, double y, double z) { return x * y * z < 0.0; })), 1);
    EXPECT_GE(countNodes(
                  scaled([](double x, double y, double z) { return x * y * z > 0.0 && (x != y || y != z); })),
              1);
}

TEST(GalleryScene, HasTheLightsAndCameras) {
    std::map<std::string, int> types;
    for (const Json& light : document().json["extensions"]["KHR_lights_punctual"]["lights"]) {
        ++types[light["type"].get<std::string>()];
        EXPECT_EQ(light.contains("spot"), light["type"] == "spot");
    }
    EXPECT_EQ(types["directional"], 1);
    EXPECT_GE(types["point"], 2);
    EXPECT_EQ(types["spot"], 1);
    ASSERT_EQ(document().json["cameras"].size(), 2U);
    EXPECT_EQ(document().json["cameras"][0]["name"], "main");
    EXPECT_EQ(document().json["cameras"][1]["name"], "detail");
}

TEST(GalleryScene, TheEveningHasTheSameGeometryAnotherSunAndASky) {
    const TemporaryFolder folder;
    ASSERT_TRUE(writeGallery(folder.path(), TimeOfDay::Evening).ok());
    auto evening = filesOf(folder.path());
    EXPECT_EQ(evening.at("evening.bin"), document().binary);
    const Json json = Json::parse(evening.at("evening.gltf"));
    EXPECT_EQ(json["materials"], document().json["materials"]);
    EXPECT_EQ(json["cameras"][0]["name"], "evening");
    EXPECT_NE(json["extensions"]["KHR_lights_punctual"],
              document().json["extensions"]["KHR_lights_punctual"]);
    EXPECT_EQ(evening.at("evening.hdr").substr(0, 10), "#?RADIANCE");
}

TEST(GalleryScene, ReportsAFolderThatCannotBeMade) {
    const TemporaryFolder folder;
    std::ofstream(folder.path() / "file") << "not a folder";
    const glint::Status status = writeGallery(folder.path() / "file" / "below");
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.error().id, "gallery-write");
    EXPECT_NE(status.error().where.find("below"), std::string::npos);
}

TEST(GalleryMaterial, WritesWhatDiffersFromTheDefaults) {
    EXPECT_EQ(Json(toJson(MaterialSpec{.name = "Plain"})),
              Json::parse(R"({"name":"Plain","pbrMetallicRoughness":{}})"));
    const Json json =
        toJson(MaterialSpec{.name = "Full",
                            .metallic = 0.0,
                            .emissiveStrength = 1.0,
                            .normalTexture = {3, 1, TextureTransform{{0.5, 0.0}, 0.25, {1.0, 1.0}}, 0.0},
                            .alphaMode = "MASK",
                            .unlit = true,
                            .extensions = {{"KHR_materials_clearcoat",
                                            {{"clearcoatFactor", 0.5}},
                                            {{"clearcoatNormalTexture", {4, 0, std::nullopt, 2.0}}}}}});
    EXPECT_EQ(json, Json::parse(R"({
        "name": "Full", "pbrMetallicRoughness": {"metallicFactor": 0.0},
        "normalTexture": {"index": 3, "texCoord": 1, "scale": 0.0,
            "extensions": {"KHR_texture_transform": {"offset": [0.5, 0.0], "rotation": 0.25}}},
        "alphaMode": "MASK",
        "extensions": {"KHR_materials_unlit": {}, "KHR_materials_emissive_strength": {"emissiveStrength": 1.0},
            "KHR_materials_clearcoat": {"clearcoatFactor": 0.5,
                "clearcoatNormalTexture": {"index": 4, "scale": 2.0}}}
    })"));
}

}  // namespace gallery::test
