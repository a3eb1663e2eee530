// Tests --trust-textures: what textures hold changes packages and no picture.
#include "cli/command.h"
#include "unit/gltf/gltf_builder.h"
#include "unit/gltf/png_writer.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace glint::testing {
namespace {

using test::Json;

class TrustTextures : public CommandTest {
protected:
    // Writes a row of squares that face the camera, each with a material and the image that it reads.
    void SetUp() override {
        CommandTest::SetUp();
        test::GltfBuilder builder;
        for (const auto& [name, material] : materials()) {
            const int index = builder.append("materials", material);
            const float left = -2.0F + static_cast<float>(index);
            const std::vector<float> positions{left, 0, 0, left + 0.9F, 0, 0, left + 0.9F, 1, 0, left, 1, 0};
            const std::vector<float> normals{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
            const std::vector<float> coordinates{0, 1, 1, 1, 1, 0, 0, 0};
            builder.addMesh(
                {{"attributes",
                  {{"POSITION", builder.addAccessor(positions, 3)},
                   {"NORMAL", builder.addAccessor(normals, 3)},
                   {"TEXCOORD_0", builder.addAccessor(coordinates, 2)}}},
                 {"indices", builder.addAccessor(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, 1)},
                 {"material", index}});
            builder.append("images", {{"uri", name + ".png"}});
            builder.append("textures", {{"source", index}});
        }
        builder.root["extensionsUsed"] = {"KHR_materials_clearcoat", "KHR_materials_transmission"};
        writeText(path("scene.gltf"), builder.text());
        // Red, green, blue and alpha of two texels.
        writeImage("rough", {255, 128, 255, 255, 255, 255, 255, 255});
        writeImage("uncoated", {0, 9, 9, 255, 0, 255, 255, 255});
        writeImage("opaque", {30, 60, 90, 200, 255, 255, 0, 255});
        writeImage("closed", {0, 255, 0, 255, 0, 0, 255, 255});
    }

    static std::vector<std::pair<std::string, Json>> materials() {
        const auto at = [](int index) { return Json{{"index", index}}; };
        return {{"rough", {{"pbrMetallicRoughness", {{"metallicRoughnessTexture", at(0)}}}}},
                {"uncoated",
                 {{"extensions",
                   {{"KHR_materials_clearcoat", {{"clearcoatFactor", 1}, {"clearcoatTexture", at(1)}}}}}}},
                {"opaque", {{"alphaMode", "MASK"}, {"pbrMetallicRoughness", {{"baseColorTexture", at(2)}}}}},
                {"closed",
                 {{"occlusionTexture", at(3)},
                  {"pbrMetallicRoughness", {{"metallicFactor", 0}}},
                  {"extensions",
                   {{"KHR_materials_transmission",
                     {{"transmissionFactor", 1}, {"transmissionTexture", at(3)}}}}}}}};
    }

    void writeImage(const std::string& name, const base::Bytes& texels) const {
        const base::Bytes png = test::makePng({2, 1, 8, test::PngColor::Rgba, {}, texels});
        writeText(path(name + ".png"), std::string(png.begin(), png.end()));
    }

    Outcome compile(const std::string& package, const std::string& trust) const {
        return run({"compile", "scene.gltf", "-o", package, "--effects", "auto", "--trust-textures=" + trust,
                    "--depfile", package + ".d", "--json"});
    }

    std::set<std::string> featuresOf(const std::string& package) const {
        std::set<std::string> features;
        const Json manifest = Json::parse(readText(path(package) / "manifest.json"));
        for (const Json& shaderCase : manifest.at("shaders")) {
            for (const char* const list : {"always", "sometimes"}) {
                for (const Json& name : shaderCase.at(list)) {
                    features.insert(name);
                }
            }
        }
        return features;
    }

    bool refracts(const std::string& package) const {
        const Json manifest = Json::parse(readText(path(package) / "manifest.json"));
        return std::ranges::any_of(manifest.at("effects"), [](const Json& effect) {
            return effect.at("name") == "refraction" && effect.at("chosen") == true;
        });
    }
};

TEST_F(TrustTextures, LeavesOutWhatTexturesMakeNeedless) {
    ASSERT_EQ(compile("blind", "off").exit, 0);
    ASSERT_EQ(compile("seen", "on").exit, 0);
    const std::set<std::string> blind = featuresOf("blind");
    const std::set<std::string> seen = featuresOf("seen");
    for (const char* const feature :
         {"clearcoat", "clearcoatTexture", "transmission", "transmissionTexture"}) {
        EXPECT_TRUE(blind.contains(feature)) << feature;
        EXPECT_FALSE(seen.contains(feature)) << feature;
    }
    EXPECT_TRUE(seen.contains("metallicRoughnessTexture"));
    EXPECT_TRUE(refracts("blind"));
    EXPECT_FALSE(refracts("seen"));
    EXPECT_TRUE(has(readText(path("seen.d")), "uncoated.png"));
    EXPECT_FALSE(has(readText(path("blind.d")), "uncoated.png"));
    const std::string explained = run({"explain", "scene.gltf", "--json"}).out;
    EXPECT_TRUE(has(explained, "(by what textures hold: clearcoatTexture.r is 0 in /images/1)")) << explained;
    EXPECT_TRUE(has(explained,
                    "metallicRoughnessTexture.g is 0.502 to 1, at texels (0, 0) and (1, 0) of "
                    "/images/0)"))
        << explained;
}

TEST_F(TrustTextures, IsTheDefaultUnlessTexturesMayChange) {
    ASSERT_EQ(run({"compile", "scene.gltf", "-o", "plain"}).exit, 0);
    EXPECT_FALSE(featuresOf("plain").contains("clearcoat"));
    ASSERT_EQ(run({"compile", "scene.gltf", "-o", "live", "--fallback"}).exit, 0);
    EXPECT_TRUE(featuresOf("live").contains("clearcoat"));
    EXPECT_TRUE(featuresOf("live").contains("transmissionTexture"));
    const Outcome drawn =
        run({"render", "scene.gltf", "-o", "a.png", "--size", "32x18", "--package", "live"});
    EXPECT_EQ(drawn.exit, 0) << "the scene is read as the package was made: " << drawn.err;
    const Outcome both = run({"compile", "scene.gltf", "-o", "none", "--fallback", "--trust-textures"});
    EXPECT_EQ(both.exit, 2);
    EXPECT_TRUE(has(both.err, "--fallback")) << both.err;
}

// A bench reads the scene as each of its packages was made.
TEST_F(TrustTextures, ABenchTakesPackagesThatTrustNone) {
    ASSERT_EQ(compile("blind", "off").exit, 0);
    const Outcome outcome = must(run({"bench",      "scene.gltf",  "-o",          "out",
                                      "--quick",    "--size",      "16x9",        "--spp",
                                      "1",          "--only",      "spp",         "--depth",
                                      "singles",    "--rounds",    "1",           "--reference-error",
                                      "1",          "--candidate", "blind=blind", "--strategy",
                                      "visibility", "--json"}));
    EXPECT_FALSE(has(outcome.err, "bench-point")) << outcome.err;
    const Json points = outcome.json().at("points");
    EXPECT_TRUE(std::ranges::any_of(points, [](const Json& point) { return point.at("name") == "blind"; }));
}

TEST_F(TrustTextures, DoesWithoutAnImageThatCantBeRead) {
    writeText(path("uncoated.png"), "no image");
    std::filesystem::remove(path("closed.png"));
    const Outcome outcome = must(compile("package", "on"));
    EXPECT_TRUE(has(outcome.err, "texture-unknown")) << outcome.err;
    EXPECT_TRUE(featuresOf("package").contains("clearcoat"));
    EXPECT_TRUE(featuresOf("package").contains("transmission"));
}

TEST_F(TrustTextures, FollowsTheImage) {
    ASSERT_EQ(compile("package", "on").exit, 0);
    EXPECT_TRUE(compile("package", "on").json().at("upToDate").get<bool>());
    EXPECT_FALSE(featuresOf("package").contains("clearcoat"));
    writeImage("uncoated", {0, 9, 9, 255, 1, 255, 255, 255});
    EXPECT_FALSE(compile("package", "on").json().at("upToDate").get<bool>());
    EXPECT_TRUE(featuresOf("package").contains("clearcoat"));
}

TEST_F(TrustTextures, ChangesNoPicture) {
    for (const char* const trust : {"off", "on"}) {
        must(run({"render", "scene.gltf", "-o", std::string(trust) + ".exr", "--size", "48x16", "--spp", "2",
                  "--effects", "auto", std::string("--trust-textures=") + trust}));
    }
    const Json compared = run({"compare", "off.exr", "on.exr", "--json"}).json();
    EXPECT_EQ(compared.at("maxAbsolute").at("value"), 0.0) << compared;
}

}  // namespace
}  // namespace glint::testing
