// Tests which effects a scene calls for.
#include "plan/effects.h"

#include "plan/plan.h"
#include "support/effect_bits.h"
#include "support/features.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace {

using namespace glint;
using namespace glint::package;

constexpr compiler::EffectRequest kAuto{true, 0};
constexpr compiler::SceneLights kLit{true};
constexpr compiler::SceneLights kDark{false};

materials::Material rough() {
    materials::Material material;
    material.name = "Plaster";
    material["metallicFactor"] = 0.0F;
    return material;
}

// A primitive with one UV set, so that textures can be read.
materials::PrimitiveInputs primitiveOf(int material) {
    materials::PrimitiveInputs primitive;
    primitive.material = material;
    primitive.hasTexCoords0 = true;
    return primitive;
}

std::uint32_t effectsOf(const std::vector<materials::Material>& materials,
                        const compiler::SceneLights& lights = kLit,
                        const compiler::EffectRequest& request = kAuto) {
    std::vector<materials::PrimitiveInputs> primitives;
    for (std::size_t i = 0; i < materials.size(); ++i) {
        primitives.push_back(primitiveOf(static_cast<int>(i)));
    }
    return decideEffects(materials, primitives, lights, request).effects.all;
}

std::string reasonOf(const materials::Material& material, Effect effect,
                     const compiler::EffectRequest& request = kAuto,
                     const compiler::SceneLights& lights = kLit) {
    const materials::PrimitiveInputs primitive = primitiveOf(0);
    return decideEffects({&material, 1}, {&primitive, 1}, lights, request)
        .decisions[effectNumber(effect)]
        .reason;
}

TEST(Effects, ShadowNeedsALightAndSomethingLit) {
    EXPECT_EQ(effectsOf({rough()}), kEffectShadow);
    EXPECT_EQ(effectsOf({rough()}, kDark), 0U);
    materials::Material unlit = rough();
    unlit.give("KHR_materials_unlit");
    EXPECT_EQ(effectsOf({unlit}), 0U);
    EXPECT_EQ(effectsOf({unlit, rough()}), kEffectShadow);
    EXPECT_EQ(effectsOf({}), 0U);
    EXPECT_EQ(reasonOf(rough(), kEffectShadow, kAuto, kDark), "no light shines");
    EXPECT_EQ(reasonOf(unlit, kEffectShadow), "every material is unlit");
}

TEST(Effects, ReflectionNeedsSomethingSmooth) {
    materials::Material material = rough();
    material["roughnessFactor"] = 0.31F;
    EXPECT_EQ(effectsOf({material}) & kEffectReflection, 0U);
    EXPECT_NE(effectsOf({material}, kLit, {true, 0, 0.31F}) & kEffectReflection, 0U);
    material["roughnessFactor"] = 0.3F;
    EXPECT_NE(effectsOf({material}) & kEffectReflection, 0U);
    EXPECT_EQ(reasonOf(material, kEffectReflection),
              "material \"Plaster\" has the roughness 0.3, at most 0.3");
    // Values decide: this material is smooth, but reflects nothing.
    material["specularFactor"] = 0.0F;
    EXPECT_EQ(effectsOf({material}) & kEffectReflection, 0U);
    material["specularFactor"] = 0.01F;
    EXPECT_NE(effectsOf({material}) & kEffectReflection, 0U);
}

TEST(Effects, ATextureMayBeSmootherThanItsFactor) {
    materials::Material material = rough();
    material.texture("metallicRoughnessTexture").texture = 0;
    EXPECT_NE(effectsOf({material}) & kEffectReflection, 0U);
}

// Planning of effects and of keys share one truth: a texture without UVs makes no part of a metal dielectric.
TEST(Effects, ATextureThatCannotBeReadChangesNothing) {
    materials::Material material = rough();
    material["metallicFactor"] = 1.0F;
    material["transmissionFactor"] = 1.0F;
    material.texture("metallicRoughnessTexture").texture = 0;
    materials::PrimitiveInputs primitive;
    const auto effects = [&] {
        return decideEffects({&material, 1}, {&primitive, 1}, kLit, kAuto).effects.all &
               (kEffectRefraction | kEffectReflection);
    };
    EXPECT_EQ(effects(), 0U);
    EXPECT_EQ(compiler::makeKey(material, primitive, {}) & bit("transmission"), 0U);
    primitive.hasTexCoords0 = true;
    EXPECT_EQ(effects(), kEffectRefraction | kEffectReflection);
    EXPECT_NE(compiler::makeKey(material, primitive, {}) & bit("transmission"), 0U);
}

TEST(Effects, ACoatReflectsIfItCoversSomething) {
    materials::Material material = rough();
    material.give("KHR_materials_clearcoat");
    EXPECT_EQ(effectsOf({material}) & kEffectReflection, 0U);
    material["clearcoatFactor"] = 0.1F;
    EXPECT_NE(effectsOf({material}) & kEffectReflection, 0U);
    material["clearcoatRoughnessFactor"] = 0.5F;
    EXPECT_EQ(effectsOf({material}) & kEffectReflection, 0U);
    material.texture("clearcoatRoughnessTexture").texture = 0;
    EXPECT_NE(effectsOf({material}) & kEffectReflection, 0U);
}

TEST(Effects, GlossinessIsRoughnessTurnedAround) {
    materials::Material material = rough();
    material.give("KHR_materials_pbrSpecularGlossiness");
    material["glossinessFactor"] = 0.5F;
    EXPECT_EQ(effectsOf({material}) & kEffectReflection, 0U);
    // Textures can only make it rougher.
    material.texture("metallicRoughnessTexture").texture = 0;
    EXPECT_EQ(effectsOf({material}) & kEffectReflection, 0U);
    material["glossinessFactor"] = 0.8F;
    EXPECT_NE(effectsOf({material}) & kEffectReflection, 0U);
    material["glossySpecularFactor"] = {0.0F, 0.0F, 0.0F};
    EXPECT_EQ(effectsOf({material}) & kEffectReflection, 0U);
}

TEST(Effects, RefractionNeedsLightThatPasses) {
    materials::Material material = rough();
    material.give("KHR_materials_transmission");
    EXPECT_EQ(effectsOf({material}) & kEffectRefraction, 0U);
    material["transmissionFactor"] = 0.5F;
    EXPECT_NE(effectsOf({material}) & kEffectRefraction, 0U);
    EXPECT_EQ(reasonOf(material, kEffectRefraction), "material \"Plaster\" transmits 0.5 of the light");
    materials::Material metal = material;
    metal["metallicFactor"] = 1.0F;
    EXPECT_EQ(effectsOf({metal}) & kEffectRefraction, 0U);
    materials::Material black = material;
    black["baseColorFactor"] = {0.0F, 0.0F, 0.0F, 1.0F};
    EXPECT_EQ(effectsOf({black}) & kEffectRefraction, 0U);
    material.give("KHR_materials_unlit");
    EXPECT_EQ(effectsOf({material}) & kEffectRefraction, 0U);
}

TEST(Effects, RefinementsAreThereWhenNamed) {
    EXPECT_EQ(effectsOf({rough()}, kDark, {true, kEffectAmbientOcclusion}), kEffectAmbientOcclusion);
    EXPECT_EQ(effectsOf({rough()}, kDark, {false, kEffectIndirectDiffuse}), kEffectIndirectDiffuse);
    EXPECT_EQ(effectsOf({rough()}, kLit, {false, 0}), 0U);
    EXPECT_EQ(effectsOf({rough()}, kLit, {true, kAllEffects}), kBuiltinEffects);
}

TEST(Effects, WhatIsAskedForIsThereEvenIfUnusable) {
    const materials::Material material = rough();
    const materials::PrimitiveInputs primitive = primitiveOf(0);
    const compiler::EffectPlan plan =
        decideEffects({&material, 1}, {&primitive, 1}, kDark, {false, kEffectRefraction});
    EXPECT_EQ(plan.effects.all, kEffectRefraction);
    EXPECT_EQ(plan.effects.walks, kEffectRefraction);
    ASSERT_EQ(plan.decisions.size(), materials::builtinMaterialModel().effects.size());
    const compiler::EffectDecision& decision = plan.decisions[effectNumber(kEffectRefraction)];
    EXPECT_TRUE(decision.chosen);
    EXPECT_FALSE(decision.usable);
    EXPECT_EQ(decision.reason, "asked for, though no material transmits light");
    for (const compiler::EffectDecision& each : plan.decisions) {
        EXPECT_FALSE(each.reason.empty()) << each.name;
    }
}

TEST(Effects, SlotsCountEffectsWithRays) {
    const std::vector<materials::EffectDeclaration>& effects = materials::builtinMaterialModel().effects;
    const EffectSet some = effectSetOf(effects, kEffectShadow | kEffectReflection | kEffectIndirectDiffuse);
    EXPECT_EQ(some.lights, kEffectShadow);
    EXPECT_EQ(some.rays, kEffectReflection | kEffectIndirectDiffuse);
    EXPECT_EQ(some.screenStarts, kEffectReflection);
    EXPECT_EQ(some.walks, 0U);
    EXPECT_EQ(effectSlots(some), 2U);
    EXPECT_EQ(effectSlot(some, kEffectReflection), 0U);
    EXPECT_EQ(effectSlot(some, kEffectIndirectDiffuse), 1U);
    EXPECT_EQ(effectSlot(effectSetOf(effects, kAllEffects), kEffectIndirectDiffuse), 2U);
    EXPECT_EQ(countedEffects(some), 5U);
    EXPECT_EQ(countedEffects(effectSetOf(effects, kEffectReflection)), 3U);
}

TEST(Effects, BitsAreThoseOfTheDeclarations) {
    const std::vector<materials::EffectDeclaration>& effects = materials::builtinMaterialModel().effects;
    EXPECT_EQ(findEffect(effects, "shadow"), kEffectShadow);
    EXPECT_EQ(findEffect(effects, "ambient-occlusion"), kEffectAmbientOcclusion);
    EXPECT_EQ(findEffect(effects, "reflection"), kEffectReflection);
    EXPECT_EQ(findEffect(effects, "refraction"), kEffectRefraction);
    EXPECT_EQ(findEffect(effects, "indirect-diffuse"), kEffectIndirectDiffuse);
    EXPECT_EQ(findEffect(effects, "glow"), 0U);
    EXPECT_EQ(effectSetOf(effects, kAllEffects).all, kBuiltinEffects);
}

}  // namespace
