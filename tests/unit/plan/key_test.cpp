// Tests canonical keys: a key has a feature if its value matters; otherwise the feature is dropped with a
// reason.
#include "unit/plan/full_material.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>

namespace {

using namespace glint;

using namespace glint::testing;

TEST(FeatureTable, IsConsistent) {
    FeatureMask seen = 0;
    std::vector<std::string_view> names;
    for (const FeatureInfo& info : featureTable()) {
        EXPECT_EQ(seen & bit(info.feature), 0U) << info.name << " shares its bit";
        seen |= bit(info.feature);
        for (const std::string_view text : {info.name, info.shortName, info.macro, info.gltf, info.neutral}) {
            EXPECT_FALSE(text.empty()) << info.name;
        }
        EXPECT_TRUE(info.macro.starts_with("GLINT_")) << info.macro;
        for (const std::string_view other : names) {
            EXPECT_NE(other, info.name);
        }
        names.push_back(info.name);
        EXPECT_NE(featureDefines().find(std::string(info.macro) + " 0x"), std::string::npos);
    }
    EXPECT_EQ(featureNames(seen).size(), featureTable().size());
}

TEST(FeatureTable, DefinesNumberBitsWithinTheirWord) {
    EXPECT_NE(featureDefines().find("#define GLINT_UNLIT 0x1u\n"), std::string::npos);
    EXPECT_NE(featureDefines().find("#define GLINT_BASE_COLOR_TEXTURE 0x1u\n"), std::string::npos);
    EXPECT_NE(featureDefines().find("#define GLINT_METALLIC_ROUGHNESS_TEXTURE 0x2u\n"), std::string::npos);
}

TEST(Key, HasEveryFeatureThatMatters) {
    Dropped dropped;
    const FeatureMask key = makeKey(fullMaterial(), fullPrimitive(), kTested, &dropped);
    for (const FeatureInfo& info : featureTable()) {
        const bool excluded = info.feature == Feature::Unlit || info.feature == Feature::SpecularGlossiness ||
                              info.feature == Feature::ClearcoatSharesNormal;
        EXPECT_EQ((key & bit(info.feature)) != 0, !excluded) << info.name;
    }
    EXPECT_TRUE(dropped.empty());
}

TEST(Key, OfTheDefaultMaterialIsEmpty) {
    Dropped dropped;
    EXPECT_EQ(makeKey(Material{}, PrimitiveInputs{}, kTested, &dropped), 0U);
    EXPECT_TRUE(dropped.empty());
}

// Each neutral value removes its feature from the key and gives a reason. Its twin in
// HasEveryFeatureThatMatters keeps the feature.
struct NeutralCase {
    std::string feature;
    std::function<void(Material&, PrimitiveInputs&)> neutralise;
    Feature gone;
};

class NeutralValue : public ::testing::TestWithParam<NeutralCase> {};

TEST_P(NeutralValue, LeavesTheKeyWithAReason) {
    Material material = fullMaterial();
    PrimitiveInputs primitive = fullPrimitive();
    GetParam().neutralise(material, primitive);
    Dropped dropped;
    const FeatureMask key = makeKey(material, primitive, kTested, &dropped);
    EXPECT_EQ(key & bit(GetParam().gone), 0U);
    EXPECT_FALSE(reasonFor(dropped, GetParam().feature).empty());
}

void clearBase(Material& material) {
    material.baseColorFactor = {0.0F, 0.0F, 0.0F, 1.0F};
    material.alphaMode = AlphaMode::Opaque;
}

INSTANTIATE_TEST_SUITE_P(
    All, NeutralValue,
    ::testing::Values(
        NeutralCase{"baseColorTexture", [](Material& m, PrimitiveInputs&) { clearBase(m); },
                    Feature::BaseColorTexture},
        NeutralCase{"baseColorTexture",
                    [](Material&, PrimitiveInputs& p) {
                        p.hasTexCoords0 = false;
                        p.hasTexCoords1 = false;
                    },
                    Feature::BaseColorTexture},
        NeutralCase{"baseColorTexture",
                    [](Material& m, PrimitiveInputs&) { m.texture(TextureSlot::BaseColor).texCoord = 2; },
                    Feature::BaseColorTexture},
        NeutralCase{"metallicRoughnessTexture",
                    [](Material& m, PrimitiveInputs&) {
                        m.metallicFactor = 0.0F;
                        m.roughnessFactor = 0.0F;
                    },
                    Feature::MetallicRoughnessTexture},
        NeutralCase{"normalTexture", [](Material& m, PrimitiveInputs&) { m.normalScale = 0.0F; },
                    Feature::NormalTexture},
        NeutralCase{"tangents",
                    [](Material& m, PrimitiveInputs&) {
                        m.normalScale = 0.0F;
                        m.clearcoat.normalScale = 0.0F;
                        m.anisotropy.strength = 0.0F;
                    },
                    Feature::Tangents},
        NeutralCase{"tangents", [](Material&, PrimitiveInputs& p) { p.hasNormals = false; },
                    Feature::Tangents},
        NeutralCase{"occlusionTexture", [](Material& m, PrimitiveInputs&) { m.occlusionStrength = 0.0F; },
                    Feature::OcclusionTexture},
        NeutralCase{"emissiveTexture",
                    [](Material& m, PrimitiveInputs&) {
                        m.emissiveFactor = {0.0F, 0.0F, 0.0F};
                    },
                    Feature::EmissiveTexture},
        NeutralCase{"emissiveTexture", [](Material& m, PrimitiveInputs&) { m.emissiveStrength = 0.0F; },
                    Feature::EmissiveTexture},
        NeutralCase{"emissiveStrength", [](Material& m, PrimitiveInputs&) { m.emissiveStrength = 1.0F; },
                    Feature::EmissiveStrength},
        NeutralCase{"emissiveStrength",
                    [](Material& m, PrimitiveInputs&) {
                        m.emissiveFactor = {0.0F, 0.0F, 0.0F};
                    },
                    Feature::EmissiveStrength},
        NeutralCase{
            "textureTransform",
            [](Material& m, PrimitiveInputs&) { m.texture(TextureSlot::BaseColor).transform.rotation = 0; },
            Feature::TextureTransform},
        NeutralCase{"textureTransform", [](Material& m, PrimitiveInputs&) { clearBase(m); },
                    Feature::TextureTransform},
        NeutralCase{"vertexColor", [](Material&, PrimitiveInputs& p) { p.colors = ColorContent::White; },
                    Feature::VertexColor},
        NeutralCase{"vertexColor", [](Material& m, PrimitiveInputs&) { clearBase(m); }, Feature::VertexColor},
        NeutralCase{"alphaMask", [](Material& m, PrimitiveInputs&) { m.alphaCutoff = 0.0F; },
                    Feature::AlphaMask},
        NeutralCase{"alphaMask",
                    [](Material& m, PrimitiveInputs& p) {
                        m.texture(TextureSlot::BaseColor).texture = -1;
                        p.colors = ColorContent::None;
                    },
                    Feature::AlphaMask},
        NeutralCase{"alphaMask", [](Material& m, PrimitiveInputs&) { m.alphaMode = AlphaMode::Blend; },
                    Feature::AlphaMask}));

// Only a base that is part metal, part dielectric pays for both.
TEST(Key, HasBothBasesWhereMetalAndDielectricMix) {
    const auto hasBoth = [](float metallic, bool textured) {
        Material material;
        material.metallicFactor = metallic;
        material.texture(TextureSlot::MetallicRoughness).texture = textured ? 0 : -1;
        return (makeKey(material, fullPrimitive(), kTested) & bit(Feature::PartialMetal)) != 0;
    };
    EXPECT_FALSE(hasBoth(0.0F, false));
    EXPECT_FALSE(hasBoth(0.0F, true));
    EXPECT_TRUE(hasBoth(0.5F, false));
    EXPECT_TRUE(hasBoth(0.5F, true));
    EXPECT_FALSE(hasBoth(1.0F, false));
    EXPECT_TRUE(hasBoth(1.0F, true));

    Material glossy;
    glossy.metallicFactor = 0.5F;
    glossy.specularGlossiness.given = true;
    EXPECT_EQ(makeKey(glossy, fullPrimitive(), kTested) & bit(Feature::PartialMetal), 0U);
}

TEST(Key, RaysMeetAlphaMasksThatCanFail) {
    Material material;
    const PrimitiveInputs primitive = fullPrimitive();
    const auto masked = [&] { return hasAlphaMasks({&material, 1}, {&primitive, 1}); };
    EXPECT_FALSE(masked());
    material.alphaMode = AlphaMode::Mask;
    EXPECT_TRUE(masked());
    material.alphaCutoff = 0.0F;
    EXPECT_FALSE(masked());
    material.alphaCutoff = 0.5F;
    material.alphaMode = AlphaMode::Blend;
    EXPECT_FALSE(masked());
}

TEST(Key, AStrengthOfZeroIsNotNeutralForALightSource) {
    Material material = fullMaterial();
    material.emissiveStrength = 0.0F;
    EXPECT_NE(makeKey(material, fullPrimitive(), kTested) & bit(Feature::EmissiveStrength), 0U);
}

TEST(Key, OfAnUnlitMaterialReadsTheBaseColorAlone) {
    Material material = fullMaterial();
    material.unlit = true;
    Dropped dropped;
    const FeatureMask key = makeKey(material, fullPrimitive(), kTested, &dropped);
    const FeatureMask expected = bit(Feature::Unlit) | bit(Feature::BaseColorTexture) |
                                 bit(Feature::TexCoord0) | bit(Feature::TextureTransform) |
                                 bit(Feature::VertexColor) | bit(Feature::AlphaMask);
    EXPECT_EQ(key, expected);
    for (const FeatureInfo& info : featureTable()) {
        const bool lost = (makeKey(fullMaterial(), fullPrimitive(), kTested) & ~key & bit(info.feature)) != 0;
        if (lost && info.feature != Feature::TexCoord1) {
            EXPECT_FALSE(reasonFor(dropped, std::string(info.name)).empty()) << info.name;
        }
    }
}

TEST(Key, ForcedOpaqueDropsAlphaModeAndSaysSo) {
    Dropped dropped;
    const FeatureMask key = makeKey(fullMaterial(), fullPrimitive(), {AlphaPolicy::Opaque}, &dropped);
    EXPECT_EQ(key & bit(Feature::AlphaMask), 0U);
    EXPECT_NE(reasonFor(dropped, "alphaMask").find("--alpha opaque"), std::string::npos);
}

TEST(Key, IgnoresNamesAndConstantValues) {
    Material a = fullMaterial();
    Material b = fullMaterial();
    b.name = "another";
    b.baseColorFactor = {0.1F, 0.2F, 0.3F, 0.4F};
    b.roughnessFactor = 0.25F;
    b.alphaCutoff = 0.7F;
    b.texture(TextureSlot::Normal).texture = 17;
    EXPECT_EQ(makeKey(a, fullPrimitive(), kTested), makeKey(b, fullPrimitive(), kTested));
}

TEST(Key, NamesExtensionsThatAreNotShaded) {
    Material material;
    material.unsupportedExtensions = {"KHR_materials_future"};
    Dropped dropped;
    makeKey(material, PrimitiveInputs{}, kTested, &dropped);
    EXPECT_FALSE(reasonFor(dropped, "KHR_materials_future").empty());
}

TEST(Key, ReadsOnlyTheUvSetsOfLiveTextures) {
    Material material;
    material.texture(TextureSlot::BaseColor).texture = 0;
    material.texture(TextureSlot::BaseColor).texCoord = 1;
    const FeatureMask key = makeKey(material, fullPrimitive(), kTested);
    EXPECT_EQ(key & bit(Feature::TexCoord0), 0U);
    EXPECT_NE(key & bit(Feature::TexCoord1), 0U);
}

}  // namespace
