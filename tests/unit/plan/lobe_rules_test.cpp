// Tests how lobes and their inputs depend on each other, and on the lobes that hits keep.
#include "support/features.h"
#include "unit/plan/full_material.h"

#include <gtest/gtest.h>

#include <string>

namespace {

using namespace glint;
using namespace glint::testing;

TEST(LobeKey, ValuesDecideWhateverTheFileGives) {
    materials::Material material;
    material["clearcoatFactor"] = 1.0F;
    material["ior"] = 2.0F;
    material["metallicFactor"] = 0.0F;
    Dropped dropped;
    EXPECT_EQ(compiler::makeKey(material, {}, {}, &dropped), bit("clearcoat") | bit("ior"));
    EXPECT_TRUE(dropped.empty());
}

TEST(LobeKey, SpecularStaysWhereItsFactorIsZero) {
    materials::Material material = fullMaterial();
    material["specularFactor"] = 0.0F;
    EXPECT_NE(compiler::makeKey(material, fullPrimitive(), kTested) & bit("specular"), 0U);
}

TEST(LobeKey, SpecularGlossinessExcludesTheOthersButNotTheCore) {
    materials::Material material = fullMaterial();
    material.give("KHR_materials_pbrSpecularGlossiness");
    Dropped dropped;
    const materials::FeatureMask key = compiler::makeKey(material, fullPrimitive(), kTested, &dropped);
    EXPECT_EQ(key & materials::builtinMaterialModel().lobes, bit("specularGlossiness"));
    for (const std::string_view lobe :
         materials::builtinMaterialModel().names(materials::builtinMaterialModel().lobes)) {
        const bool is = lobe == "unlit" || lobe == "specularGlossiness";
        EXPECT_EQ(reasonFor(dropped, std::string(lobe)).empty(), is) << lobe;
    }
    for (const char* const kept :
         {"baseColorTexture", "metallicRoughnessTexture", "normalTexture", "emissiveStrength", "tangents"}) {
        EXPECT_NE(key & bit(kept), 0U);
    }
}

TEST(LobeKey, SpecularGlossinessTextureIsNeutralWhereBothFactorsAreZero) {
    materials::Material material = fullMaterial();
    material.give("KHR_materials_pbrSpecularGlossiness");
    material["glossySpecularFactor"] = {0.0F, 0.0F, 0.0F};
    material["glossinessFactor"] = 0.0F;
    const auto reads = [&] {
        return (compiler::makeKey(material, fullPrimitive(), kTested) & bit("metallicRoughnessTexture")) != 0;
    };
    EXPECT_FALSE(reads());
    material["glossinessFactor"] = 0.5F;
    EXPECT_TRUE(reads());
    // The factors of the other workflow have no effect.
    material["metallicFactor"] = 0.0F;
    material["roughnessFactor"] = 0.0F;
    EXPECT_TRUE(reads());
}

TEST(LobeKey, UnlitWinsOverSpecularGlossiness) {
    materials::Material material = fullMaterial();
    material.give("KHR_materials_unlit");
    material.give("KHR_materials_pbrSpecularGlossiness");
    Dropped dropped;
    EXPECT_EQ(compiler::makeKey(material, fullPrimitive(), kTested, &dropped) &
                  materials::builtinMaterialModel().lobes,
              bit("unlit"));
    EXPECT_FALSE(reasonFor(dropped, "specularGlossiness").empty());
}

// If the coat's normal texture equals the base's in every detail, it is read once.
TEST(LobeKey, CoatSharesAnEqualNormalTexture) {
    const materials::FeatureMask shares = bit("clearcoatSharesNormal");
    const materials::FeatureMask own = bit("clearcoatNormalTexture");
    materials::Material equal = fullMaterial();
    equal.texture("clearcoatNormalTexture") = equal.texture("normalTexture");
    equal["clearcoatNormalScale"] = float{equal["normalScale"]};
    const auto keyOf = [&](const materials::Material& material) {
        return compiler::makeKey(material, fullPrimitive(), kTested) & (shares | own);
    };
    EXPECT_EQ(keyOf(equal), shares);
    EXPECT_EQ(keyOf(fullMaterial()), own);
    materials::Material other = equal;
    other.texture("clearcoatNormalTexture").texCoord = 1;
    EXPECT_EQ(keyOf(other), own);
    other = equal;
    other.texture("clearcoatNormalTexture").transform.offset[1] = 0.5F;
    EXPECT_EQ(keyOf(other), own);
    other = equal;
    other["clearcoatNormalScale"] = 0.5F;
    EXPECT_EQ(keyOf(other), own);
    // The base reads no texture, because its scale is 0; the coat's scale is then 0 too.
    other = equal;
    other["normalScale"] = 0.0F;
    EXPECT_EQ(keyOf(other), own);
    other["clearcoatNormalScale"] = 0.0F;
    EXPECT_EQ(keyOf(other), 0U);
}

TEST(LobeKey, TangentsServeEachOfTheirReaders) {
    const auto hasTangents = [](const materials::Material& material) {
        return (compiler::makeKey(material, fullPrimitive(), {}) & bit("tangents")) != 0;
    };
    materials::Material material;
    EXPECT_FALSE(hasTangents(material));
    material["anisotropyStrength"] = 1.0F;
    material["roughnessFactor"] = 0.5F;
    EXPECT_TRUE(hasTangents(material));
    material = materials::Material();
    material["clearcoatFactor"] = 1.0F;
    EXPECT_FALSE(hasTangents(material));
    material.texture("clearcoatNormalTexture").texture = 0;
    EXPECT_TRUE(hasTangents(material));
}

TEST(LobeKey, AnisotropyWithoutTangentsReadsTextureCoordinates) {
    materials::Material material;
    material["anisotropyStrength"] = 1.0F;
    material["roughnessFactor"] = 0.5F;
    materials::PrimitiveInputs primitive = fullPrimitive();
    const materials::FeatureMask sets = bit("texCoord0") | bit("texCoord1");
    EXPECT_EQ(compiler::makeKey(material, primitive, {}) & sets, 0U);
    primitive.hasTangents = false;
    EXPECT_EQ(compiler::makeKey(material, primitive, {}) & sets, bit("texCoord0"));
    primitive.hasTexCoords0 = false;
    EXPECT_EQ(compiler::makeKey(material, primitive, {}) & sets, bit("texCoord1"));
    // The frame uses the set of a texture.
    primitive.hasTexCoords0 = true;
    material.texture("anisotropyTexture") = {0, 1, {}, false};
    EXPECT_EQ(compiler::makeKey(material, primitive, {}) & sets, bit("texCoord1"));
}

TEST(LobeKey, EveryTextureCountsForUvSetsAndTransforms) {
    for (std::size_t slot = 0; slot < materials::builtinMaterialModel().textures.size(); ++slot) {
        materials::Material material = fullMaterial();
        for (auto& [number, info] : material.textures) {
            info.transform = {};
            info.texCoord = 0;
        }
        const materials::FeatureMask both = bit("texCoord1") | bit("textureTransform");
        EXPECT_EQ(compiler::makeKey(material, fullPrimitive(), kTested) & both, 0U) << slot;
        material.textures[slot].texCoord = 1;
        material.textures[slot].transform.scale[0] = 2.0F;
        EXPECT_EQ(compiler::makeKey(material, fullPrimitive(), kTested) & both, both) << slot;
    }
}

TEST(HitLobes, ALobeThatHitsDoNotKeepTakesItsInputsWithIt) {
    for (const materials::Feature& info : materials::builtinMaterialModel().features) {
        const materials::FeatureMask lobe = info.mask() & materials::builtinMaterialModel().lobes;
        if (lobe == 0 || info.name == "unlit" || info.name == "specularGlossiness") {
            continue;
        }
        Dropped dropped;
        const materials::FeatureMask whole = compiler::makeKey(fullMaterial(), fullPrimitive(), kTested);
        const materials::FeatureMask kept = compiler::makeKey(
            fullMaterial(), fullPrimitive(),
            {package::AlphaPolicy::Tested, materials::builtinMaterialModel().lobes & ~lobe}, &dropped);
        EXPECT_EQ(kept & lobe, 0U) << info.name;
        EXPECT_EQ(kept & ~whole, 0U) << info.name;
        EXPECT_NE(reasonFor(dropped, std::string(info.name)).find("hits do not keep it"), std::string::npos);
        for (const std::string_view name : materials::builtinMaterialModel().names(whole & ~kept)) {
            EXPECT_NE(reasonFor(dropped, std::string(name)).find("--hit-lobes"), std::string::npos) << name;
        }
    }
}

TEST(HitLobes, NoneLeavesTheCoreAndTheBaseModels) {
    const materials::KeyOptions none{package::AlphaPolicy::Tested, 0};
    const materials::FeatureMask core = compiler::makeKey(fullMaterial(), fullPrimitive(), none);
    EXPECT_EQ(core & materials::builtinMaterialModel().lobes, 0U);
    for (const char* const texture : {"baseColorTexture", "metallicRoughnessTexture", "normalTexture",
                                      "occlusionTexture", "emissiveTexture"}) {
        EXPECT_NE(core & bit(texture), 0U);
    }
    EXPECT_EQ(core & (bit("clearcoatTexture") | bit("thicknessTexture")), 0U);
    materials::Material other = fullMaterial();
    other.give("KHR_materials_pbrSpecularGlossiness");
    EXPECT_EQ(compiler::makeKey(other, fullPrimitive(), none) & materials::builtinMaterialModel().lobes,
              bit("specularGlossiness"));
    other.give("KHR_materials_unlit");
    EXPECT_EQ(compiler::makeKey(other, fullPrimitive(), none) & materials::builtinMaterialModel().lobes,
              bit("unlit"));
}

}  // namespace
