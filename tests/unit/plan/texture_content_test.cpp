// Tests what planning concludes from what textures hold.
#include "plan/effects.h"
#include "support/effect_bits.h"
#include "support/features.h"
#include "unit/plan/full_material.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace {

using namespace glint;
using namespace glint::testing;

using Content = std::array<materials::ValueInterval, 4>;

constexpr Content kOnes{{{1.0, 1.0}, {1.0, 1.0}, {1.0, 1.0}, {1.0, 1.0}}};
constexpr Content kZeros{};

materials::Material fullOf(const char* texture, const Content& content) {
    materials::Material material = fullMaterial();
    material.texture(texture).content.of = content;
    return material;
}

// Returns what differs from the key of a material whose textures may hold anything.
std::vector<std::string> lostBy(const char* texture, const Content& content, Dropped* dropped = nullptr) {
    const materials::FeatureMask whole = compiler::makeKey(fullMaterial(), fullPrimitive(), kTested, nullptr);
    const materials::FeatureMask key =
        compiler::makeKey(fullOf(texture, content), fullPrimitive(), kTested, dropped);
    EXPECT_EQ(key & ~whole, 0U) << texture;
    return materials::builtinMaterialModel().names(whole & ~key);
}

TEST(TextureContent, OfOnesIsNotRead) {
    for (const materials::MaterialTexture& texture : materials::builtinMaterialModel().textures) {
        const std::string& name = texture.name;
        const bool hasDirections =
            name == "normalTexture" || name == "clearcoatNormalTexture" || name == "anisotropyTexture";
        const std::vector<std::string> lost = lostBy(name.c_str(), kOnes);
        EXPECT_EQ(std::ranges::find(lost, name) != lost.end(), !hasDirections) << name;
    }
    // One channel that is not 1 is enough to read it, if it is one that is read.
    Content almost = kOnes;
    almost[1].low = 0.999;
    EXPECT_TRUE(lostBy("metallicRoughnessTexture", almost).empty());
    almost = kOnes;
    almost[0].low = 0.0;
    EXPECT_EQ(lostBy("metallicRoughnessTexture", almost),
              (std::vector<std::string>{"metallicRoughnessTexture"}));
}

TEST(TextureContent, OfZerosTakesTheLobeWithIt) {
    const struct {
        const char* texture;
        const char* feature;
    } kRows[] = {
        {"clearcoatTexture", "clearcoat"},       {"sheenColorTexture", "sheen"},
        {"transmissionTexture", "transmission"}, {"diffuseTransmissionTexture", "diffuseTransmission"},
        {"iridescenceTexture", "iridescence"},   {"anisotropyTexture", "anisotropy"}};
    for (const auto& row : kRows) {
        Dropped dropped;
        const std::vector<std::string> lost = lostBy(row.texture, kZeros, &dropped);
        EXPECT_NE(std::ranges::find(lost, row.feature), lost.end()) << row.texture;
        const std::string reason = reasonFor(dropped, row.feature);
        EXPECT_NE(reason.find("(by what textures hold: " + std::string(row.texture) + "."), std::string::npos)
            << reason;
    }
}

// The record keeps the factor, so a texture that makes a product 0 has to be read where the product still
// counts.
TEST(TextureContent, OfZerosIsReadWhereItsProductCounts) {
    for (const char* const texture :
         {"baseColorTexture", "metallicRoughnessTexture", "emissiveTexture", "specularTexture",
          "specularColorTexture", "sheenRoughnessTexture", "clearcoatRoughnessTexture", "thicknessTexture"}) {
        const std::vector<std::string> lost = lostBy(texture, kZeros);
        EXPECT_EQ(std::ranges::find(lost, texture), lost.end()) << texture;
    }
}

TEST(TextureContent, OfAlphaMakesAMaskOpaque) {
    Content alpha{materials::kUnitInterval, materials::kUnitInterval, materials::kUnitInterval,
                  materials::ValueInterval{0.5, 1.0}};
    materials::PrimitiveInputs primitive = fullPrimitive();
    primitive.colors = materials::ColorContent::None;
    const auto isMasked = [&] {
        const materials::Material material = fullOf("baseColorTexture", alpha);
        return (compiler::makeKey(material, primitive, kTested, nullptr) & bit("alphaMask")) != 0;
    };
    EXPECT_FALSE(isMasked());  // The cut-off is 0.5.
    alpha[3].low = 0.4999;
    EXPECT_TRUE(isMasked());
}

TEST(TextureContent, OfRoughnessDecidesAboutReflections) {
    materials::Material material;
    material.texture("metallicRoughnessTexture").texture = 0;
    materials::PrimitiveInputs primitive;
    primitive.hasTexCoords0 = true;
    const materials::EffectDeclaration& reflection = materials::builtinMaterialModel().effects[2];
    ASSERT_EQ(reflection.name, "reflection");
    EXPECT_TRUE(compiler::sendsRays(reflection, material, primitive, 0.3F));
    material.texture("metallicRoughnessTexture").content.of[1] = {0.31, 1.0};
    EXPECT_FALSE(compiler::sendsRays(reflection, material, primitive, 0.3F));
    material.texture("metallicRoughnessTexture").content.of[1] = {0.29, 1.0};
    EXPECT_TRUE(compiler::sendsRays(reflection, material, primitive, 0.3F));
    // Another channel says nothing about roughness.
    material.texture("metallicRoughnessTexture").content.of = {};
    material.texture("metallicRoughnessTexture").content.of[1] = materials::kUnitInterval;
    EXPECT_TRUE(compiler::sendsRays(reflection, material, primitive, 0.3F));
}

// Half of a code is as near to no tilt as 8 bits come.
TEST(TextureContent, OfFlatNormalsIsNotRead) {
    Content flat{{{127.0 / 255.0, 128.0 / 255.0}, {128.0 / 255.0, 128.0 / 255.0}, {1.0, 1.0}, {1.0, 1.0}}};
    for (const char* const texture : {"normalTexture", "clearcoatNormalTexture"}) {
        const std::vector<std::string> lost = lostBy(texture, flat);
        EXPECT_NE(std::ranges::find(lost, texture), lost.end()) << texture;
    }
    flat[1].high = 129.0 / 255.0;
    EXPECT_TRUE(lostBy("normalTexture", flat).empty());
    flat[1].high = 128.0 / 255.0;
    flat[2].low = 0.5;
    EXPECT_TRUE(lostBy("normalTexture", flat).empty());
}

// A primitive that sees a part of a texture decides by that part.
TEST(TextureContent, IsWhatThePrimitiveSees) {
    materials::Material material;
    material.texture("metallicRoughnessTexture").texture = 0;
    materials::PrimitiveInputs whole;
    whole.hasTexCoords0 = true;
    materials::PrimitiveInputs part = whole;
    materials::TextureContent content;
    content.of[1] = {0.4, 0.6};
    content.image = "/images/3";
    content.leastAt[1] = {0, 7, 9};
    content.greatestAt[1] = {2, 1, 0};
    part.seen = {{materials::builtinMaterialModel().findTexture("metallicRoughnessTexture"), content}};
    const compiler::EffectRequest request{.automatic = true};
    const auto reflection = [&](std::initializer_list<materials::PrimitiveInputs> primitives) {
        return compiler::decideEffects({&material, 1}, {primitives.begin(), primitives.size()}, {}, request)
            .decisions[2];
    };
    EXPECT_TRUE(reflection({whole}).usable);
    EXPECT_TRUE(reflection({part, whole}).usable);
    const compiler::EffectDecision rough = reflection({part});
    EXPECT_FALSE(rough.usable);
    EXPECT_NE(rough.reason.find(
                  "metallicRoughnessTexture.g is 0.4 to 0.6, at texels (7, 9) and (1, 0) of level 2 of "
                  "/images/3"),
              std::string::npos)
        << rough.reason;
}

}  // namespace
