// Tests what an import with ImportOptions::trustTextures knows of textures and tangents, and what it changes.
#include "gltf/trusted_textures.h"

#include "gltf/texels/levels.h"
#include "support/must.h"
#include "unit/gltf/packed_scenes.h"
#include "unit/gltf/png_writer.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace glint::test {
namespace {

constexpr int kNearest = 9728;

// Squares with coordinates in [left, right] x [0, 1], each with a material that the test gives.
class Squares {
public:
    int addImage(const PngSpec& spec) {
        const base::Bytes png = makePng(spec);
        return builder.append(
            "images", {{"bufferView", builder.addView(png.data(), png.size())}, {"mimeType", "image/png"}});
    }
    // Adds a texture that shows single texels of the finest level.
    int addTexture(int image) {
        if (!builder.root.contains("samplers")) {
            builder.append("samplers", {{"minFilter", kNearest}, {"magFilter", kNearest}});
        }
        return builder.append("textures", {{"source", image}, {"sampler", 0}});
    }
    void add(int material, float left, float right, bool hasCoordinates = true) {
        Json attributes{
            {"POSITION", builder.addAccessor(std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, 3)}};
        if (hasCoordinates) {
            attributes["TEXCOORD_0"] =
                builder.addAccessor(std::vector<float>{left, 1, right, 1, right, 0, left, 0}, 2);
        }
        builder.addMesh({{"attributes", attributes},
                         {"indices", builder.addAccessor(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, 1)},
                         {"material", material}});
    }
    int addMaterial(const char* texture, int index, Json factors = Json::object()) {
        factors[texture] = {{"index", index}};
        return builder.append("materials", {{"pbrMetallicRoughness", std::move(factors)}});
    }
    gltf::Scene read(gltf::ImportOptions options = {}) const {
        options.trustTextures = true;
        return must(import(builder, options));
    }

    GltfBuilder builder;
};

// Four texels: two of roughness 0.2, two of 0.8; metal is 0.4 everywhere.
const PngSpec kHalves{4, 1, 8, PngColor::Rgb, {}, {1, 51, 102, 2, 51, 102, 3, 204, 102, 4, 204, 102}};

TEST(TrustedTextures, PrimitivesSeeTheirPartOfATexture) {
    Squares squares;
    const int material =
        squares.addMaterial("metallicRoughnessTexture", squares.addTexture(squares.addImage(kHalves)));
    squares.add(material, 0.05F, 0.45F);
    squares.add(material, 0.55F, 0.95F);
    squares.add(material, 0.05F, 0.95F);
    const gltf::Scene scene = squares.read();
    ASSERT_EQ(scene.meshes.size(), 3U);
    const auto roughness = [&](std::size_t mesh) {
        const std::vector<materials::SeenTexture>& seen = scene.meshes[mesh].primitives[0].seen;
        return seen.empty() ? materials::kAnything : seen[0].content.of[1];
    };
    EXPECT_NEAR(roughness(0).high, 0.2, 1e-4);
    EXPECT_NEAR(roughness(1).low, 0.8, 1e-4);
    EXPECT_NEAR(roughness(2).low, 0.2, 1e-4);
    EXPECT_NEAR(roughness(2).high, 0.8, 1e-4);
    EXPECT_EQ(scene.meshes[1].primitives[0].seen[0].content.leastAt[1].x, 2);
}

TEST(TrustedTextures, ConstantsBecomeFactors) {
    Squares squares;
    const int texture = squares.addTexture(squares.addImage(kHalves));
    const int one = squares.addMaterial("metallicRoughnessTexture", texture,
                                        {{"roughnessFactor", 0.5}, {"metallicFactor", 0.5}});
    const int both = squares.addMaterial("metallicRoughnessTexture", texture);
    const int partly = squares.addMaterial("metallicRoughnessTexture", texture);
    squares.add(one, 0.05F, 0.45F);
    squares.add(both, 0.05F, 0.45F);
    squares.add(both, 0.55F, 0.95F);
    squares.add(partly, 0.05F, 0.45F);
    squares.add(partly, 0.05F, 0.45F, false);  // reads 1 there
    const gltf::Scene scene = squares.read();
    const materials::Material& folded = scene.materials[0];
    EXPECT_EQ(folded.texture("metallicRoughnessTexture").texture, -1);
    EXPECT_TRUE(folded.texture("metallicRoughnessTexture").isFolded);
    EXPECT_EQ(folded["roughnessFactor"], 0.5F * (51.0F / 255.0F));
    EXPECT_EQ(folded["metallicFactor"], 0.5F * (102.0F / 255.0F));
    EXPECT_EQ(scene.materials[1].texture("metallicRoughnessTexture").texture, 0);
    EXPECT_EQ(scene.materials[2].texture("metallicRoughnessTexture").texture, 0);
    EXPECT_EQ(scene.materials[2]["roughnessFactor"], 1.0F);
}

// The files differ: one has no alpha.
TEST(TrustedTextures, EqualTexelsAreOneTexture) {
    Squares squares;
    const int first = squares.addTexture(squares.addImage({2, 1, 8, PngColor::Rgb, {}, {1, 2, 3, 4, 5, 6}}));
    const int second =
        squares.addTexture(squares.addImage({2, 1, 8, PngColor::Rgba, {}, {1, 2, 3, 255, 4, 5, 6, 255}}));
    const int other =
        squares.addTexture(squares.addImage({2, 1, 8, PngColor::Rgba, {}, {1, 2, 3, 255, 4, 5, 7, 255}}));
    for (const int texture : {first, second, other}) {
        squares.add(squares.addMaterial("baseColorTexture", texture), 0.0F, 1.0F);
    }
    // The same texels as data: their levels are other ones.
    squares.add(squares.addMaterial(
                    "metallicRoughnessTexture",
                    squares.addTexture(squares.addImage({2, 1, 8, PngColor::Rgb, {}, {1, 2, 3, 4, 5, 6}}))),
                0.0F, 1.0F);
    const gltf::Scene scene = squares.read();
    const auto textureOf = [&](std::size_t material, const char* name) {
        return scene.materials[material].texture(name).texture;
    };
    EXPECT_EQ(textureOf(0, "baseColorTexture"), textureOf(1, "baseColorTexture"));
    EXPECT_NE(textureOf(0, "baseColorTexture"), textureOf(2, "baseColorTexture"));
    EXPECT_NE(textureOf(0, "baseColorTexture"), textureOf(3, "metallicRoughnessTexture"));
    EXPECT_EQ(scene.images.size(), 4U);
    EXPECT_EQ(scene.images[1].sameAs, 0);
    EXPECT_EQ(scene.images[3].sameAs, -1);
}

// Levels of roughness are other ones than those of what else a channel may hold.
TEST(TrustedTextures, EqualTexelsShareTheLevelsOfTheirChannels) {
    Squares squares;
    const auto texture = [&] {
        const PngSpec texels{2, 1, 8, PngColor::Rgb, {}, {1, 2, 3, 4, 5, 6}};
        return Json{{"index", squares.addTexture(squares.addImage(texels))}};
    };
    // Red as occlusion, green and blue as roughness and metal, and green as the thickness of a volume.
    const Json materials[] = {
        {{"occlusionTexture", texture()}},
        {{"pbrMetallicRoughness", {{"metallicRoughnessTexture", texture()}}}},
        {{"extensions",
          {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
           {"KHR_materials_volume", {{"thicknessFactor", 1}, {"thicknessTexture", texture()}}}}}}};
    for (const Json& material : materials) {
        squares.add(squares.builder.append("materials", material), 0.0F, 1.0F);
    }
    const gltf::Scene scene = squares.read();
    ASSERT_EQ(scene.images.size(), 3U);
    EXPECT_EQ(scene.images[1].sameAs, 0);
    EXPECT_EQ(scene.images[2].sameAs, -1);
    const std::vector<gltf::ImageUse> uses = imageUses(scene);
    EXPECT_EQ(uses[0].channels, 7U);
    EXPECT_EQ(uses[0].roughness, 2U);
    EXPECT_EQ(uses[2].roughness, 0U);
}

// Values that an animation sets would lose the product.
TEST(TrustedTextures, AnimatedMaterialsKeepTheirTextures) {
    Squares squares;
    squares.add(
        squares.addMaterial("metallicRoughnessTexture", squares.addTexture(squares.addImage(kHalves))), 0.05F,
        0.45F);
    squares.builder.root["extensionsUsed"] = {"KHR_animation_pointer"};
    const int times = squares.builder.addAccessor(std::vector<float>{0, 1}, 1);
    squares.builder.root["accessors"][static_cast<std::size_t>(times)]["min"] = {0};
    squares.builder.root["accessors"][static_cast<std::size_t>(times)]["max"] = {1};
    const int values = squares.builder.addAccessor(std::vector<float>{0, 1}, 1);
    squares.builder.append(
        "animations", {{"samplers", {{{"input", times}, {"output", values}}}},
                       {"channels",
                        {{{"sampler", 0},
                          {"target",
                           {{"path", "pointer"},
                            {"extensions",
                             {{"KHR_animation_pointer",
                               {{"pointer", "/materials/0/pbrMetallicRoughness/roughnessFactor"}}}}}}}}}}});
    const gltf::Scene scene = squares.read();
    ASSERT_EQ(scene.animatedMaterials.size(), 1U);
    EXPECT_EQ(scene.materials[0].texture("metallicRoughnessTexture").texture, 0);
    EXPECT_EQ(scene.materials[0]["roughnessFactor"], 1.0F);
}

class CountingMemo final : public base::Memo {
public:
    std::optional<std::string> find(std::string_view kind, std::string_view key) override {
        const std::lock_guard lock(mutex_);
        const auto found = values_.find({std::string(kind), std::string(key)});
        return found == values_.end() ? std::nullopt : std::optional(found->second);
    }
    void put(std::string_view kind, std::string_view key, std::string_view value) override {
        const std::lock_guard lock(mutex_);
        values_[{std::string(kind), std::string(key)}] = value;
        ++puts;
    }
    int puts = 0;

private:
    std::mutex mutex_;
    std::map<std::pair<std::string, std::string>, std::string> values_;
};

TEST(TrustedTextures, AreReadOncePerContent) {
    const auto build = [](const PngSpec& spec, float right) {
        Squares squares;
        squares.add(
            squares.addMaterial("metallicRoughnessTexture", squares.addTexture(squares.addImage(spec))),
            0.05F, right);
        return squares;
    };
    CountingMemo memo;
    const auto read = [&](const Squares& squares) {
        memo.puts = 0;
        const gltf::Scene scene = squares.read({.memo = &memo});
        return std::pair(memo.puts, scene.materials[0]["roughnessFactor"] + 0.0F);
    };
    EXPECT_EQ(read(build(kHalves, 0.45F)), std::pair(2, 0.2F));
    EXPECT_EQ(read(build(kHalves, 0.45F)), std::pair(0, 0.2F));
    EXPECT_EQ(read(build(kHalves, 0.95F)), std::pair(1, 1.0F));  // other coordinates in the same image
    PngSpec changed = kHalves;
    changed.rows[1] = 204;
    changed.rows[4] = 204;
    EXPECT_EQ(read(build(changed, 0.45F)), std::pair(1, 0.8F));  // constant everywhere
}

TEST(TrustedTextures, TangentsOfTheCoordinatesAreDerived) {
    gltf::Primitive square;
    square.positions = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}};
    square.normals.assign(4, {0, 0, 1});
    square.texCoords0 = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    square.indices = {0, 1, 2, 0, 2, 3};
    square.tangents.assign(4, {1, 0, 0, 1});
    EXPECT_TRUE(derivesTangents(square));
    gltf::Primitive other = square;
    other.tangents[3] = {1, 0, 0, -1};
    EXPECT_FALSE(derivesTangents(other)) << "the bitangent points down";
    other = square;
    other.tangents[2] = {std::cos(2e-4F), std::sin(2e-4F), 0, 1};
    EXPECT_FALSE(derivesTangents(other)) << "turned by more than the tolerance";
    other = square;
    other.texCoords1 = {{1, 0}, {1, 1}, {0, 1}, {0, 0}};
    EXPECT_FALSE(derivesTangents(other)) << "the second set gives another direction";
    other = square;
    other.texCoords0.assign(4, {0.5F, 0.5F});
    EXPECT_FALSE(derivesTangents(other)) << "nothing can be derived";
    other = square;
    other.targets.emplace_back();
    EXPECT_FALSE(derivesTangents(other)) << "morph targets turn them";
}

}  // namespace
}  // namespace glint::test
