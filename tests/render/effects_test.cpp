// Effects in pictures: ways to run them agree, gates are counted, and what is off changes nothing.
#include "render/pixel_test.h"
#include "render/rooms.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace {

using namespace glint;
using namespace glint::testing;

CompileSettings allEffects() {
    CompileSettings settings;
    settings.effects = {false, package::kAllEffects};
    settings.strategies = package::kAllStrategies;
    settings.tracers = package::kAllTracers;
    return settings;
}

RenderSetup smallSetup(const Scene& scene) {
    RenderSetup setup = defaultSetup(scene, 48, 32);
    setup.frame.maxReflectionRoughness = 1.0F;
    setup.frame.countsLight = true;
    setup.samples = 2;
    return setup;
}

RendererOptions optionsOf(package::Strategy strategy, package::Tracer tracer) {
    RendererOptions options;
    options.strategy = strategy;
    options.tracer = tracer;
    options.checkOrder = true;
    return options;
}

// The room through panes of glass: one thin, one thick, both partly clear.
Scene roomBehindGlass() {
    Scene scene = roomOfMaterials();
    Material pane;
    pane.metallicFactor = 0.0F;
    pane.roughnessFactor = 0.1F;
    pane.transmission.factor = 0.8F;
    pane.doubleSided = true;
    addInstance(scene, addMesh(scene, makeQuad(addMaterial(scene, pane), {-1.2F, -0.4F, -1.2F}, {1, 0, 0},
                                               {0, 1, 0})));
    pane.transmission.factor = 1.0F;
    pane.volume.thicknessFactor = 0.2F;
    pane.volume.attenuationDistance = 0.5F;
    pane.volume.attenuationColor = {0.9F, 0.5F, 0.4F};
    const int thick = addMaterial(scene, pane);
    addInstance(scene, addMesh(scene, makeQuad(thick, {0.1F, -0.4F, -1.2F}, {1, 0, 0}, {0, 1, 0})));
    addInstance(scene, addMesh(scene, makeQuad(thick, {1.1F, -0.4F, -1.4F}, {-1, 0, 0}, {0, 1, 0})));
    return scene;
}

struct Way {
    package::Strategy strategy;
    package::Tracer tracer;
    bool batch;
};

TEST(AllEffects, EveryWayMakesTheSamePicture) {
    const Scene scene = roomBehindGlass();
    const LoadedScene loaded(scene, allEffects());
    ASSERT_TRUE(loaded.ok());
    const RenderSetup setup = smallSetup(scene);
    FrameCounters first;
    const LinearImage reference =
        loaded.render(optionsOf(package::kStrategyUber, package::kTracerRayQuery), setup, &first);
    ASSERT_FALSE(reference.pixels.empty());
    for (const package::Effect effect :
         {package::kEffectReflection, package::kEffectRefraction, package::kEffectIndirectDiffuse}) {
        const EffectCounters counters = first.of(effect);
        EXPECT_GT(counters.rays, 0U) << package::nameOf(effect);
        EXPECT_EQ(counters.hits + counters.misses, counters.rays) << package::nameOf(effect);
    }
    EXPECT_GT(first.of(package::kEffectRefraction).segments, 0U);
    EXPECT_GT(first.of(package::kEffectShadow).rays, 0U);
    EXPECT_GT(first.of(package::kEffectAmbientOcclusion).hits, 0U);
    for (const Way& way : {Way{package::kStrategyVisibility, package::kTracerRayQuery, false},
                           Way{package::kStrategyVisibility, package::kTracerRayQuery, true},
                           Way{package::kStrategySortedUber, package::kTracerRayPipeline, true},
                           Way{package::kStrategyHitShaders, package::kTracerRayPipeline, false}}) {
        RendererOptions options = optionsOf(way.strategy, way.tracer);
        options.batchEffects = way.batch;
        const std::string what =
            std::string(package::nameOf(way.strategy)) + (way.batch ? ", batched" : ", one by one");
        FrameCounters counters;
        const LinearImage image = loaded.render(options, setup, &counters);
        expectSameImage(image, reference, what);
        EXPECT_EQ(counters.rays, first.rays) << what;
        EXPECT_EQ(counters.orderErrors, 0U) << what;
        for (const EffectCounters& effect : counters.effects) {
            const EffectCounters other = first.of(effect.effect);
            EXPECT_EQ(effect.rays, other.rays) << what << ", " << package::nameOf(effect.effect);
            EXPECT_EQ(effect.hits, other.hits) << what << ", " << package::nameOf(effect.effect);
        }
    }
}

TEST(AllEffects, AnswerDeferredShadowsAndPackedRecords) {
    const Scene scene = roomBehindGlass();
    RenderSetup setup = smallSetup(scene);
    CompileSettings settings = allEffects();
    settings.tracers = package::kTracerRayQuery;
    settings.strategies = package::kStrategyVisibility;
    const LoadedScene plain(scene, settings);
    settings.shadows = package::ShadowPlacement::Deferred;
    settings.hitRecord = package::HitRecordFormat::Packed;
    const LoadedScene packed(scene, settings);
    ASSERT_TRUE(plain.ok() && packed.ok());
    const LinearImage a = plain.render(package::kStrategyVisibility, setup);
    const LinearImage b = packed.render(package::kStrategyVisibility, setup);
    ASSERT_EQ(a.pixels.size(), b.pixels.size());
    // Packed records round barycentrics and directions: shadows at edges and refracted paths may change.
    std::size_t different = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        for (std::size_t channel = 0; channel < 3; ++channel) {
            different += std::abs(a.pixels[i][channel] - b.pixels[i][channel]) >
                         0.02F * std::max(1.0F, a.pixels[i][channel]);
        }
    }
    EXPECT_LT(different, a.pixels.size() / 50);
}

// Effects that are off at run time leave the picture of a package without them.
TEST(AllEffects, OffIsAsIfTheyWereNotThere) {
    const Scene scene = roomOfMaterials();
    const RenderSetup setup = smallSetup(scene);
    CompileSettings settings = allEffects();
    settings.strategies = package::kStrategyUber;
    settings.tracers = package::kTracerRayQuery;
    const LoadedScene all(scene, settings);
    settings.effects.named = package::kEffectShadow;
    const LoadedScene bare(scene, settings);
    ASSERT_TRUE(all.ok() && bare.ok());
    RenderSetup off = setup;
    off.frame.effects = 0;
    FrameCounters counters;
    const LinearImage image = all.render(package::kStrategyUber, off, &counters);
    EXPECT_EQ(counters.rays, 0U);
    expectSameImage(image, bare.render(package::kStrategyUber, setup), "off");
}

// What a sky without borders lights: indirect light and occlusion then change nothing.
TEST(IndirectDiffuse, OfAnEmptySkyIsTheSkysLight) {
    Scene scene = emptyScene();
    addCamera(scene);
    Material white;
    white.metallicFactor = 0.0F;
    addInstance(scene,
                addMesh(scene, makeQuad(addMaterial(scene, white), {-2, -2, -1}, {4, 0, 0}, {0, 4, 0})));
    RenderSetup setup = squareSetup(scene);
    setup.samples = 4;
    CompileSettings settings;
    settings.strategies = package::kStrategyUber;
    settings.effects.named = 0;
    const LoadedScene sky(scene, settings);
    settings.effects.named = package::kEffectIndirectDiffuse | package::kEffectAmbientOcclusion;
    const LoadedScene traced(scene, settings);
    ASSERT_TRUE(sky.ok() && traced.ok());
    // Every ray of a flat wall leaves the scene, and the sky is white all over.
    FrameCounters counters;
    const LinearImage image = traced.render(package::kStrategyUber, setup, &counters);
    expectSameImage(image, sky.render(package::kStrategyUber, setup), "traced");
    EXPECT_EQ(counters.of(package::kEffectIndirectDiffuse).misses, 32U * 32U);
}

// A weight below the bound sends no ray, and is counted.
TEST(Gates, FaintSamplesAreSkipped) {
    Scene scene = emptyScene();
    addCamera(scene);
    Material glossy;
    glossy.metallicFactor = 0.0F;
    glossy.roughnessFactor = 0.0F;
    addInstance(scene,
                addMesh(scene, makeQuad(addMaterial(scene, glossy), {-2, -2, -1}, {4, 0, 0}, {0, 4, 0})));
    RenderSetup setup = squareSetup(scene);
    CompileSettings settings;
    settings.strategies = package::kStrategyUber;
    const LoadedScene loaded(scene, settings);
    ASSERT_TRUE(loaded.ok());
    FrameCounters counters;
    loaded.render(package::kStrategyUber, setup, &counters);
    EXPECT_EQ(counters.of(package::kEffectReflection).rays, 32U * 32U);
    setup.frame.faintWeight = 0.5F;  // 4 % at normal incidence
    const LinearImage image = loaded.render(package::kStrategyUber, setup, &counters);
    EXPECT_EQ(counters.of(package::kEffectReflection).rays, 0U);
    EXPECT_EQ(counters.of(package::kEffectReflection).skippedFaint, 32U * 32U);
    EXPECT_FALSE(image.pixels.empty());
}

// A spot light that misses half of the wall, and a point light whose range ends before it.
TEST(Gates, LightsAreKeptByConeRangeAndFacing) {
    Scene scene = emptyScene();
    addCamera(scene);
    Material wall;
    wall.metallicFactor = 0.0F;
    addInstance(scene,
                addMesh(scene, makeQuad(addMaterial(scene, wall), {-2, -2, -1}, {4, 0, 0}, {0, 4, 0})));
    Light light;
    light.type = LightType::Point;
    light.range = 0.5F;
    light.position = {0, 0, 0};
    scene.lights.push_back(light);
    light.type = LightType::Spot;
    light.range = 0.0F;
    light.direction = {0, 0, 1};  // away
    scene.lights.push_back(light);
    addDirectionalLight(scene, {0, 0, 1}, 1.0F);  // from behind
    RenderSetup setup = squareSetup(scene);
    setup.frame.countsLight = true;
    CompileSettings settings;
    settings.strategies = package::kStrategyUber;
    settings.effects.named = package::kEffectShadow;
    const LoadedScene loaded(scene, settings);
    ASSERT_TRUE(loaded.ok());
    FrameCounters counters;
    loaded.render(package::kStrategyUber, setup, &counters);
    const EffectCounters shadow = counters.of(package::kEffectShadow);
    EXPECT_EQ(shadow.rays, 0U);
    EXPECT_EQ(shadow.skippedRange, 32U * 32U);
    EXPECT_EQ(shadow.skippedCone, 32U * 32U);
    EXPECT_EQ(shadow.skippedFacing, 32U * 32U);
}

}  // namespace
