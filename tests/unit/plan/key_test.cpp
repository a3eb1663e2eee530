// Tests canonical keys: a key has a feature if its value matters; otherwise the feature is dropped with a
// reason.
#include "support/features.h"
#include "unit/plan/full_material.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>

namespace {

using namespace glint;

using namespace glint::testing;

TEST(FeatureTable, IsConsistent) {
    materials::FeatureMask seen = 0;
    std::vector<std::string_view> names;
    for (const materials::Feature& info : materials::builtinMaterialModel().features) {
        EXPECT_EQ(seen & info.mask(), 0U) << info.name << " shares its bit";
        seen |= info.mask();
        for (const std::string_view text : {info.name, info.shortName, info.macro, info.gltf}) {
            EXPECT_FALSE(text.empty()) << info.name;
        }
        EXPECT_TRUE(info.macro.starts_with("GLINT_")) << info.macro;
        for (const std::string_view other : names) {
            EXPECT_NE(other, info.name);
        }
        names.push_back(info.name);
        EXPECT_NE(materials::builtinMaterialModel().featureDefines().find(std::string(info.macro) + " 0x"),
                  std::string::npos);
    }
    EXPECT_EQ(materials::builtinMaterialModel().names(seen).size(),
              materials::builtinMaterialModel().features.size());
}

TEST(FeatureTable, DefinesNumberBitsWithinTheirWord) {
    EXPECT_NE(materials::builtinMaterialModel().featureDefines().find("#define GLINT_UNLIT 0x1u\n"),
              std::string::npos);
    EXPECT_NE(
        materials::builtinMaterialModel().featureDefines().find("#define GLINT_BASE_COLOR_TEXTURE 0x1u\n"),
        std::string::npos);
    EXPECT_NE(materials::builtinMaterialModel().featureDefines().find(
                  "#define GLINT_METALLIC_ROUGHNESS_TEXTURE 0x2u\n"),
              std::string::npos);
}

TEST(Key, HasEveryFeatureThatMatters) {
    Dropped dropped;
    const materials::FeatureMask key = compiler::makeKey(fullMaterial(), fullPrimitive(), kTested, &dropped);
    for (const materials::Feature& info : materials::builtinMaterialModel().features) {
        const bool excluded = info.name == "unlit" || info.name == "specularGlossiness" ||
                              info.name == "clearcoatSharesNormal" ||
                              info.role == package::Role::TurnedFrames || info.role == package::Role::Emits;
        EXPECT_EQ((key & info.mask()) != 0, !excluded) << info.name;
    }
    EXPECT_TRUE(dropped.empty());
}

TEST(Key, OfTheDefaultMaterialIsEmpty) {
    Dropped dropped;
    EXPECT_EQ(compiler::makeKey(materials::Material{}, materials::PrimitiveInputs{}, kTested, &dropped), 0U);
    EXPECT_TRUE(dropped.empty());
}

// Each neutral value removes its feature from the key and gives a reason. Its twin in
// HasEveryFeatureThatMatters keeps the feature.
struct NeutralCase {
    std::string feature;
    std::function<void(materials::Material&, materials::PrimitiveInputs&)> neutralise;
    const char* gone;
};

class NeutralValue : public ::testing::TestWithParam<NeutralCase> {};

TEST_P(NeutralValue, LeavesTheKeyWithAReason) {
    materials::Material material = fullMaterial();
    materials::PrimitiveInputs primitive = fullPrimitive();
    GetParam().neutralise(material, primitive);
    Dropped dropped;
    const materials::FeatureMask key = compiler::makeKey(material, primitive, kTested, &dropped);
    EXPECT_EQ(key & bit(GetParam().gone), 0U);
    EXPECT_FALSE(reasonFor(dropped, GetParam().feature).empty());
}

void clearBase(materials::Material& material) {
    material["baseColorFactor"] = {0.0F, 0.0F, 0.0F, 1.0F};
    material.alphaMode = materials::AlphaMode::Opaque;
}

INSTANTIATE_TEST_SUITE_P(All, NeutralValue,
                         ::testing::Values(
                             NeutralCase{
                                 "baseColorTexture",
                                 [](materials::Material& m, materials::PrimitiveInputs&) { clearBase(m); },
                                 "baseColorTexture"},
                             NeutralCase{"baseColorTexture",
                                         [](materials::Material&, materials::PrimitiveInputs& p) {
                                             p.hasTexCoords0 = false;
                                             p.hasTexCoords1 = false;
                                         },
                                         "baseColorTexture"},
                             NeutralCase{"baseColorTexture",
                                         [](materials::Material& m, materials::PrimitiveInputs&) {
                                             m.texture("baseColorTexture").texCoord = 2;
                                         },
                                         "baseColorTexture"},
                             NeutralCase{"metallicRoughnessTexture",
                                         [](materials::Material& m, materials::PrimitiveInputs&) {
                                             m["metallicFactor"] = 0.0F;
                                             m["roughnessFactor"] = 0.0F;
                                         },
                                         "metallicRoughnessTexture"},
                             NeutralCase{"normalTexture",
                                         [](materials::Material& m, materials::PrimitiveInputs&) {
                                             m["normalScale"] = 0.0F;
                                         },
                                         "normalTexture"},
                             NeutralCase{"tangents",
                                         [](materials::Material& m, materials::PrimitiveInputs&) {
                                             m["normalScale"] = 0.0F;
                                             m["clearcoatNormalScale"] = 0.0F;
                                             m["anisotropyStrength"] = 0.0F;
                                         },
                                         "tangents"},
                             NeutralCase{"tangents",
                                         [](materials::Material&, materials::PrimitiveInputs& p) {
                                             p.hasNormals = false;
                                         },
                                         "tangents"},
                             NeutralCase{"occlusionTexture",
                                         [](materials::Material& m, materials::PrimitiveInputs&) {
                                             m["occlusionStrength"] = 0.0F;
                                         },
                                         "occlusionTexture"},
                             NeutralCase{"emissiveTexture",
                                         [](materials::Material& m, materials::PrimitiveInputs&) {
                                             m["emissiveFactor"] = {0.0F, 0.0F, 0.0F};
                                         },
                                         "emissiveTexture"},
                             NeutralCase{"emissiveTexture",
                                         [](materials::Material& m, materials::PrimitiveInputs&) {
                                             m["emissiveStrength"] = 0.0F;
                                         },
                                         "emissiveTexture"},
                             NeutralCase{"emissiveStrength",
                                         [](materials::Material& m, materials::PrimitiveInputs&) {
                                             m["emissiveStrength"] = 1.0F;
                                         },
                                         "emissiveStrength"},
                             NeutralCase{"emissiveStrength",
                                         [](materials::Material& m, materials::PrimitiveInputs&) {
                                             m["emissiveFactor"] = {0.0F, 0.0F, 0.0F};
                                         },
                                         "emissiveStrength"},
                             NeutralCase{"textureTransform",
                                         [](materials::Material& m, materials::PrimitiveInputs&) {
                                             m.texture("baseColorTexture").transform.rotation = 0;
                                         },
                                         "textureTransform"},
                             NeutralCase{
                                 "textureTransform",
                                 [](materials::Material& m, materials::PrimitiveInputs&) { clearBase(m); },
                                 "textureTransform"},
                             NeutralCase{"vertexColor",
                                         [](materials::Material&, materials::PrimitiveInputs& p) {
                                             p.colors = materials::ColorContent::White;
                                         },
                                         "vertexColor"},
                             NeutralCase{
                                 "vertexColor",
                                 [](materials::Material& m, materials::PrimitiveInputs&) { clearBase(m); },
                                 "vertexColor"},
                             NeutralCase{"alphaMask",
                                         [](materials::Material& m, materials::PrimitiveInputs&) {
                                             m["alphaCutoff"] = 0.0F;
                                         },
                                         "alphaMask"},
                             NeutralCase{"alphaMask",
                                         [](materials::Material& m, materials::PrimitiveInputs& p) {
                                             m.texture("baseColorTexture").texture = -1;
                                             p.colors = materials::ColorContent::None;
                                         },
                                         "alphaMask"},
                             NeutralCase{"alphaMask",
                                         [](materials::Material& m, materials::PrimitiveInputs&) {
                                             m.alphaMode = materials::AlphaMode::Blend;
                                         },
                                         "alphaMask"}));

// Only a base that is part metal, part dielectric pays for both.
TEST(Key, HasBothBasesWhereMetalAndDielectricMix) {
    const auto hasBoth = [](float metallic, bool textured) {
        materials::Material material;
        material["metallicFactor"] = metallic;
        material.texture("metallicRoughnessTexture").texture = textured ? 0 : -1;
        return (compiler::makeKey(material, fullPrimitive(), kTested) & bit("partialMetal")) != 0;
    };
    EXPECT_FALSE(hasBoth(0.0F, false));
    EXPECT_FALSE(hasBoth(0.0F, true));
    EXPECT_TRUE(hasBoth(0.5F, false));
    EXPECT_TRUE(hasBoth(0.5F, true));
    EXPECT_FALSE(hasBoth(1.0F, false));
    EXPECT_TRUE(hasBoth(1.0F, true));

    materials::Material glossy;
    glossy["metallicFactor"] = 0.5F;
    glossy.give("KHR_materials_pbrSpecularGlossiness");
    EXPECT_EQ(compiler::makeKey(glossy, fullPrimitive(), kTested) & bit("partialMetal"), 0U);
}

TEST(Key, RaysMeetAlphaMasksThatCanFail) {
    materials::Material material;
    const materials::PrimitiveInputs primitive = fullPrimitive();
    using enum package::AlphaPolicy;
    const auto needed = [&] { return compiler::neededAlphaPolicy({&material, 1}, {&primitive, 1}); };
    EXPECT_EQ(needed(), Opaque);
    material.alphaMode = materials::AlphaMode::Mask;
    EXPECT_EQ(needed(), Tested);
    material["alphaCutoff"] = 0.0F;
    EXPECT_EQ(needed(), Opaque);
    material["alphaCutoff"] = 0.5F;
    material.alphaMode = materials::AlphaMode::Blend;
    EXPECT_EQ(needed(), Stochastic);
}

TEST(Key, AStrengthOfZeroIsNotNeutralForALightSource) {
    materials::Material material = fullMaterial();
    material["emissiveStrength"] = 0.0F;
    EXPECT_NE(compiler::makeKey(material, fullPrimitive(), kTested) & bit("emissiveStrength"), 0U);
}

TEST(Key, OfAnUnlitMaterialReadsTheBaseColorAlone) {
    materials::Material material = fullMaterial();
    material.give("KHR_materials_unlit");
    Dropped dropped;
    const materials::FeatureMask key = compiler::makeKey(material, fullPrimitive(), kTested, &dropped);
    const materials::FeatureMask expected = bit("unlit") | bit("baseColorTexture") | bit("texCoord0") |
                                            bit("textureTransform") | bit("vertexColor") | bit("alphaMask");
    EXPECT_EQ(key, expected);
    for (const materials::Feature& info : materials::builtinMaterialModel().features) {
        const bool lost =
            (compiler::makeKey(fullMaterial(), fullPrimitive(), kTested) & ~key & info.mask()) != 0;
        if (lost && info.name != "texCoord1") {
            EXPECT_FALSE(reasonFor(dropped, std::string(info.name)).empty()) << info.name;
        }
    }
}

TEST(Key, ForcedOpaqueDropsAlphaModeAndSaysSo) {
    Dropped dropped;
    const materials::FeatureMask key =
        compiler::makeKey(fullMaterial(), fullPrimitive(), {package::AlphaPolicy::Opaque}, &dropped);
    EXPECT_EQ(key & bit("alphaMask"), 0U);
    EXPECT_NE(reasonFor(dropped, "alphaMask").find("--alpha opaque"), std::string::npos);
}

TEST(Key, IgnoresNamesAndConstantValues) {
    materials::Material a = fullMaterial();
    materials::Material b = fullMaterial();
    b.name = "another";
    b["baseColorFactor"] = {0.1F, 0.2F, 0.3F, 0.4F};
    b["roughnessFactor"] = 0.25F;
    b["alphaCutoff"] = 0.7F;
    b.texture("normalTexture").texture = 17;
    EXPECT_EQ(compiler::makeKey(a, fullPrimitive(), kTested), compiler::makeKey(b, fullPrimitive(), kTested));
}

TEST(Key, NamesExtensionsThatAreNotShaded) {
    materials::Material material;
    material.unsupportedExtensions = {"KHR_materials_future"};
    Dropped dropped;
    compiler::makeKey(material, materials::PrimitiveInputs{}, kTested, &dropped);
    EXPECT_FALSE(reasonFor(dropped, "KHR_materials_future").empty());
}

TEST(Key, FramesTurnWhereATransformTurnsThem) {
    materials::PrimitiveInputs primitive = fullPrimitive();
    primitive.hasTangents = false;
    const auto turns = [&](const char* slot, const materials::TextureTransform& transform) {
        materials::Material material = fullMaterial();
        material.texture(slot).transform = transform;
        return (compiler::makeKey(material, primitive, kTested) & bit("turnedFrames")) != 0;
    };
    for (const char* const slot : {"normalTexture", "clearcoatNormalTexture", "anisotropyTexture"}) {
        EXPECT_TRUE(turns(slot, {.rotation = 0.1F})) << slot;
        EXPECT_TRUE(turns(slot, {.rotation = 3.1415927F})) << slot;
        EXPECT_TRUE(turns(slot, {.scale = {-1, 1}})) << slot;
        EXPECT_TRUE(turns(slot, {.scale = {1, -2}})) << slot;
        EXPECT_FALSE(turns(slot, {.offset = {0.5F, 0.5F}, .scale = {2, 3}})) << slot;
        EXPECT_FALSE(turns(slot, {.scale = {0, 1}})) << slot;
        EXPECT_FALSE(turns(slot, {.rotation = 6.2831855F})) << slot << ", a whole turn";
        EXPECT_FALSE(turns(slot, {.rotation = 3.1415927F, .scale = {-1, -1}}))
            << slot << ", half a turn twice";
    }
    EXPECT_FALSE(turns("emissiveTexture", {.rotation = 1})) << "it has no frame";
}

TEST(Key, TangentsOfTheFileAreUsedAsTheyAre) {
    materials::Material material = fullMaterial();
    material.texture("normalTexture").transform.rotation = 1.0F;
    materials::PrimitiveInputs primitive = fullPrimitive();
    Dropped dropped;
    const materials::FeatureMask given = compiler::makeKey(material, primitive, kTested, &dropped);
    EXPECT_EQ(given & bit("turnedFrames"), 0U);
    EXPECT_FALSE(reasonFor(dropped, "turnedFrames").empty());
    // They say something else than the transformed UVs, even if they are those of the UVs themselves.
    primitive.derivesTangents = true;
    EXPECT_EQ(compiler::makeKey(material, primitive, kTested), given);
    material.texture("normalTexture").transform.rotation = 0.0F;
    EXPECT_EQ(compiler::makeKey(material, primitive, kTested) & bit("tangents"), 0U);
}

// Anisotropy without a texture has the frame of the normal texture, whether or not that is read.
TEST(Key, GroovesWithoutATextureHaveTheFrameOfTheNormalTexture) {
    materials::Material material;
    material.give("KHR_materials_anisotropy");
    material["anisotropyStrength"] = 0.5F;
    material["roughnessFactor"] = 0.5F;
    materials::TextureInfo& normal = material.texture("normalTexture");
    normal.texture = 0;
    normal.texCoord = 1;
    normal.transform.rotation = 1.0F;
    material["normalScale"] = 0.0F;
    materials::PrimitiveInputs primitive = fullPrimitive();
    primitive.hasTangents = false;
    const materials::FeatureMask key = compiler::makeKey(material, primitive, kTested);
    EXPECT_EQ(key & (bit("normalTexture") | bit("texCoord0")), 0U);
    EXPECT_EQ(key & (bit("texCoord1") | bit("turnedFrames")), bit("texCoord1") | bit("turnedFrames"));
    normal.texture = -1;
    EXPECT_EQ(compiler::makeKey(material, primitive, kTested) &
                  (bit("texCoord0") | bit("texCoord1") | bit("turnedFrames")),
              bit("texCoord0"));
}

TEST(Key, ReadsOnlyTheUvSetsOfLiveTextures) {
    materials::Material material;
    material.texture("baseColorTexture").texture = 0;
    material.texture("baseColorTexture").texCoord = 1;
    const materials::FeatureMask key = compiler::makeKey(material, fullPrimitive(), kTested);
    EXPECT_EQ(key & bit("texCoord0"), 0U);
    EXPECT_NE(key & bit("texCoord1"), 0U);
}

}  // namespace
