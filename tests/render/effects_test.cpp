// Effects in pictures: the ways to run them agree, gates are counted, and effects that are off change
// nothing.
#include "render/pixel_test.h"
#include "render/rooms.h"
#include "render/ways.h"
#include "support/effect_bits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace glint;
using namespace glint::testing;

compiler::CompileSettings allEffects() {
    compiler::CompileSettings settings;
    settings.effects = {false, package::kAllEffects};
    settings.strategies = package::allStrategies();
    settings.tracers = package::kAllTracers;
    return settings;
}

RenderSetup smallSetup(const gltf::Scene& scene) {
    RenderSetup setup = defaultSetup(scene, 48, 32);
    setup.frame.maxReflectionRoughness = 1.0F;
    setup.countsLight = true;
    setup.samples = 2;
    return setup;
}

// Returns the room behind panes of glass: one thin, one thick, both partly clear.
gltf::Scene roomBehindGlass() {
    gltf::Scene scene = roomBehindPane();
    materials::Material pane = scene.materials.back();
    pane["transmissionFactor"] = 1.0F;
    pane["thicknessFactor"] = 0.2F;
    pane["attenuationDistance"] = 0.5F;
    pane["attenuationColor"] = {0.9F, 0.5F, 0.4F};
    const int thick = addMaterial(scene, pane);
    addQuad(scene, thick, {0.1F, -0.4F, -1.2F}, {1, 0, 0}, {0, 1, 0});
    addQuad(scene, thick, {1.1F, -0.4F, -1.4F}, {-1, 0, 0}, {0, 1, 0});
    return scene;
}

// Returns how many values of the channels differ by more than `share` of them, or of 1 where they are less.
std::size_t countDifferent(const LinearImage& a, const LinearImage& b, float share) {
    EXPECT_EQ(a.pixels.size(), b.pixels.size());
    std::size_t different = 0;
    for (std::size_t i = 0; i < std::min(a.pixels.size(), b.pixels.size()); ++i) {
        for (std::size_t channel = 0; channel < 3; ++channel) {
            different += std::abs(a.pixels[i][channel] - b.pixels[i][channel]) >
                         share * std::max(1.0F, a.pixels[i][channel]);
        }
    }
    return different;
}

TEST(AllEffects, EveryWayMakesTheSamePicture) {
    const gltf::Scene scene = roomBehindGlass();
    const RenderSetup setup = smallSetup(scene);
    std::optional<LinearImage> reference;
    Renderer::Counters first;
    forEachWay(scene, allEffects(), [&](const LoadedScene& loaded, const Way& way) {
        const bool isVisibility = way.strategy == package::kStrategyVisibility;
        for (const bool batch : isVisibility ? std::vector{false, true} : std::vector{true}) {
            RendererOptions options = optionsOf(way);
            options.batchEffects = batch;
            const std::string what = nameOf(way) + (batch ? ", batched" : ", one by one");
            Renderer::Counters counters;
            const LinearImage image = loaded.render(options, setup, &counters);
            if (!reference) {
                reference = image;
                first = counters;
            }
            expectSameImage(image, *reference, what);
            EXPECT_EQ(counters.rays, first.rays) << what;
            EXPECT_EQ(counters.orderErrors, 0U) << what;
            for (const Renderer::EffectCounters& effect : counters.effects) {
                const Renderer::EffectCounters other = first.of(effect.effect);
                EXPECT_EQ(effect.rays, other.rays) << what << ", " << effect.name;
                EXPECT_EQ(effect.hits, other.hits) << what << ", " << effect.name;
            }
        }
    });
    for (const package::Effect effect :
         {package::kEffectReflection, package::kEffectRefraction, package::kEffectIndirectDiffuse}) {
        const Renderer::EffectCounters counters = first.of(effect);
        EXPECT_GT(counters.rays, 0U) << effect;
        EXPECT_EQ(counters.hits + counters.misses, counters.rays) << effect;
    }
    EXPECT_GT(first.of(package::kEffectRefraction).segments, 0U);
    EXPECT_GT(first.of(package::kEffectShadow).rays, 0U);
    EXPECT_GT(first.of(package::kEffectAmbientOcclusion).hits, 0U);
}

// In bands of rows, or as a frame of its own, a sample is the same to the bit. Compact vertices change it
// hardly.
TEST(AllEffects, BandsAndFramesWithoutAMeanChangeNothing) {
    const gltf::Scene scene = roomBehindGlass();
    compiler::CompileSettings settings = allEffects();
    settings.tracers = package::kTracerRayQuery;
    settings.strategies = package::kStrategyUber | package::kStrategyVisibility;
    settings.plan.merge = compiler::MergePolicy::All;
    const LoadedScene loaded(scene, settings);
    RenderSetup setup = smallSetup(scene);
    setup.samples = 1;
    for (const package::Strategy strategy : {package::kStrategyUber, package::kStrategyVisibility}) {
        RendererOptions options = optionsOf({strategy, package::kTracerRayQuery});
        Renderer::Counters whole;
        const LinearImage reference = loaded.render(options, setup, &whole);
        options.bands = 3;
        options.accumulate = false;
        options.batchEffects = strategy == package::kStrategyUber;
        Renderer::Counters counters;
        const LinearImage image = loaded.render(options, setup, &counters);
        EXPECT_EQ(image.pixels, reference.pixels);
        EXPECT_EQ(counters.rays, whole.rays);
        EXPECT_EQ(counters.orderErrors, 0U);
        EXPECT_EQ(counters.bucketCounts, whole.bucketCounts);
        for (const Renderer::EffectCounters& effect : counters.effects) {
            EXPECT_EQ(effect.rays, whole.of(effect.effect).rays) << effect.name;
            EXPECT_EQ(effect.hits, whole.of(effect.effect).hits) << effect.name;
            EXPECT_EQ(effect.skippedSky, whole.of(effect.effect).skippedSky) << effect.name;
        }
    }
}

TEST(AllEffects, AskForTheResourcesThatTheirFramesNeed) {
    const gltf::Scene scene = roomOfFewMaterials();
    compiler::CompileSettings settings;
    settings.strategies = package::kStrategyUber;
    settings.plan.merge = compiler::MergePolicy::All;
    const LoadedScene loaded(scene, settings);
    const RenderSetup setup = smallSetup(scene);
    RendererOptions options;
    options.strategy = package::kStrategyUber;
    options.width = setup.width;
    options.height = setup.height;
    options.accumulate = false;
    options.bands = 2;
    const auto renderer = loaded.makeRenderer(options);
    const auto idOf = [](const auto& result) { return result ? std::string() : result.error().id; };
    EXPECT_EQ(idOf(renderer->render(setup.frame, 2)), "frame-options");
    EXPECT_TRUE(renderer->render(setup.frame, 1));
    EXPECT_EQ(idOf(renderer->readCoverage(package::kEffectReflection)), "frame-options");
    EXPECT_TRUE(renderer->readSurfaces());
    FrameOptions marching = setup.frame;
    marching.screenSteps = 8;
    EXPECT_EQ(idOf(renderer->render(marching, 1)), "frame-options");
    for (const MemoryItem& item : renderer->memory()) {
        EXPECT_TRUE(item.name != "radiance" && item.name != "residual" && item.name != "position")
            << item.name;
    }
}

TEST(AllEffects, OfCompactVerticesAreNearlyTheSame) {
    const gltf::Scene scene = roomOfFewMaterials();
    compiler::CompileSettings settings;
    settings.strategies = package::kStrategyUber;
    settings.plan.merge = compiler::MergePolicy::All;
    const auto load = [&](SceneView::VertexForm form) {
        return LoadedScene(scene, settings, [form](session::SceneViewData& data) { data.vertices = form; });
    };
    const LoadedScene full = load(SceneView::VertexForm::Full);
    const LoadedScene compact = load(SceneView::VertexForm::Compact);
    const LoadedScene quantized = load(SceneView::VertexForm::Quantized);
    const auto bytesOf = [](const LoadedScene& loaded) {
        std::uint64_t bytes = 0;
        for (const MemoryItem& item : loaded.gpuScene().memory()) {
            bytes += item.name == "vertices and indices" ? item.bytes : 0;
        }
        return bytes;
    };
    EXPECT_LT(bytesOf(compact), bytesOf(full));
    // All positions of the room are on a grid that keeps them.
    EXPECT_LE(bytesOf(quantized), bytesOf(compact));
    const RenderSetup setup = smallSetup(scene);
    const LinearImage a = full.render(package::kStrategyUber, setup);
    for (const LoadedScene* const other : {&compact, &quantized}) {
        const LinearImage b = other->render(package::kStrategyUber, setup);
        // A ray that meets another surface, or a shadow's edge, may change a few pixels.
        EXPECT_LT(countDifferent(a, b, 0.005F), a.pixels.size() / 50);
    }
}

TEST(AllEffects, AnswerDeferredShadowsAndPackedRecords) {
    const gltf::Scene scene = roomBehindGlass();
    RenderSetup setup = smallSetup(scene);
    compiler::CompileSettings settings = allEffects();
    settings.tracers = package::kTracerRayQuery;
    settings.strategies = package::kStrategyVisibility;
    const LoadedScene plain(scene, settings);
    settings.shadows = package::ShadowPlacement::Deferred;
    settings.hitRecord = package::HitRecordFormat::Packed;
    const LoadedScene packed(scene, settings);
    const LinearImage a = plain.render(package::kStrategyVisibility, setup);
    const LinearImage b = packed.render(package::kStrategyVisibility, setup);
    // Packed records round barycentrics and directions, so shadows at edges and refracted paths may change.
    EXPECT_LT(countDifferent(a, b, 0.02F), a.pixels.size() / 50);
}

// Drivers may add and multiply in another order where they inline.
TEST(AllEffects, AreTheSameInShadersThatAreNotOptimised) {
    const gltf::Scene scene = roomBehindGlass();
    const RenderSetup setup = smallSetup(scene);
    compiler::CompileSettings settings = allEffects();
    settings.tracers = package::kTracerRayQuery;
    settings.strategies = package::kStrategyVisibility;
    const LoadedScene optimised(scene, settings);
    settings.optimize = false;
    const LoadedScene folded(scene, settings);
    const LinearImage a = optimised.render(package::kStrategyVisibility, setup);
    const LinearImage b = folded.render(package::kStrategyVisibility, setup);
    EXPECT_LT(countDifferent(a, b, 1e-4F), a.pixels.size() / 100);
}

// If effects are off at run time, the picture is that of a package without them.
TEST(AllEffects, OffIsAsIfTheyWereNotThere) {
    const gltf::Scene scene = roomOfFewMaterials();
    const RenderSetup setup = smallSetup(scene);
    compiler::CompileSettings settings = allEffects();
    settings.strategies = package::kStrategyUber;
    settings.tracers = package::kTracerRayQuery;
    const LoadedScene all(scene, settings);
    settings.effects.named = package::kEffectShadow;
    const LoadedScene bare(scene, settings);
    RenderSetup off = setup;
    off.frame.effects = 0;
    Renderer::Counters counters;
    const LinearImage image = all.render(package::kStrategyUber, off, &counters);
    EXPECT_EQ(counters.rays, 0U);
    expectSameImage(image, bare.render(package::kStrategyUber, setup), "off");
}

// Under a uniform sky, indirect light and occlusion change nothing.
TEST(IndirectDiffuse, OfAnEmptySkyIsTheSkysLight) {
    gltf::Scene scene = sceneWithCamera();
    materials::Material white;
    white["metallicFactor"] = 0.0F;
    addQuad(scene, white, {-2, -2, -1}, {4, 0, 0}, {0, 4, 0});
    RenderSetup setup = squareSetup(scene);
    setup.samples = 4;
    compiler::CompileSettings settings;
    settings.strategies = package::kStrategyUber;
    settings.effects.named = 0;
    const LoadedScene sky(scene, settings);
    settings.effects.named = package::kEffectIndirectDiffuse | package::kEffectAmbientOcclusion;
    const LoadedScene traced(scene, settings);
    // Every ray of a flat wall leaves the scene, and the sky is white everywhere.
    Renderer::Counters counters;
    const LinearImage image = traced.render(package::kStrategyUber, setup, &counters);
    expectSameImage(image, sky.render(package::kStrategyUber, setup), "traced");
    EXPECT_EQ(counters.of(package::kEffectIndirectDiffuse).misses, 32U * 32U);
}

// Returns glass that reflects nothing, so that a path does not depend on chance.
materials::Material clearGlass(float ior) {
    materials::Material glass;
    glass["metallicFactor"] = 0.0F;
    glass["roughnessFactor"] = 0.0F;
    glass["transmissionFactor"] = 1.0F;
    glass["thicknessFactor"] = 1.0F;
    glass.give("KHR_materials_ior");
    glass["ior"] = ior;
    glass.give("KHR_materials_specular");
    glass["specularFactor"] = 0.0F;
    return glass;
}

// Adds a block in front of the camera, as wide as its view, from `near` to `far` along its axis, with fronts
// outside.
void addBlock(gltf::Scene& scene, int material, float near, float far, float half) {
    const auto face = [&](gltf::Float3 corner, gltf::Float3 right, gltf::Float3 up) {
        addQuad(scene, material, corner, right, up);
    };
    const float size = 2.0F * half;
    const float depth = far - near;
    face({-half, -half, -near}, {size, 0, 0}, {0, size, 0});
    face({half, -half, -far}, {-size, 0, 0}, {0, size, 0});
    face({half, -half, -near}, {0, 0, -depth}, {0, size, 0});
    face({-half, -half, -far}, {0, 0, depth}, {0, size, 0});
    face({-half, half, -near}, {size, 0, 0}, {0, 0, -depth});
    face({-half, -half, -far}, {size, 0, 0}, {0, 0, depth});
}

// Returns a wall of coloured squares that shows where a ray goes.
gltf::Scene squaresBehind() {
    gltf::Scene scene = sceneWithCamera();
    std::vector<std::uint8_t> texels;
    for (int i = 0; i < 16 * 16; ++i) {
        const auto across = static_cast<std::uint8_t>(i % 16 * 16);
        const auto down = static_cast<std::uint8_t>(i / 16 * 16);
        texels.insert(texels.end(),
                      {across, down, (i + i / 16) % 2 != 0 ? std::uint8_t{255} : std::uint8_t{0}, 255});
    }
    materials::Material squares = unlitMaterial({1, 1, 1});
    squares.texture("baseColorTexture").texture = addTexture(scene, 16, 16, std::move(texels));
    addQuad(scene, squares, {-8, -8, -6}, {16, 0, 0}, {0, 16, 0});
    return scene;
}

LinearImage refracted(const gltf::Scene& scene) {
    compiler::CompileSettings settings;
    settings.strategies = package::kStrategyUber;
    settings.effects.named = package::kEffectRefraction;
    const LoadedScene loaded(scene, settings);
    RenderSetup setup = defaultSetup(scene, 64, 64);
    return loaded.render(package::kStrategyUber, setup);
}

// Returns the share of pixels that differ by more than the edge of a square may.
double differingShare(const LinearImage& a, const LinearImage& b) {
    EXPECT_EQ(a.pixels.size(), b.pixels.size());
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        float largest = 0.0F;
        for (std::size_t channel = 0; channel < 3; ++channel) {
            largest = std::max(largest, std::abs(a.pixels[i][channel] - b.pixels[i][channel]));
        }
        count += largest > 0.01F ? 1 : 0;
    }
    return static_cast<double>(count) / static_cast<double>(a.pixels.size());
}

TEST(NestedDielectrics, AreBoundedByTheMediumAround) {
    gltf::Scene whole = squaresBehind();
    addBlock(whole, addMaterial(whole, clearGlass(1.5F)), 1.0F, 4.0F, 12.0F);
    const LinearImage block = refracted(whole);

    // A block with the same index within is invisible.
    gltf::Scene matched = whole;
    addBlock(matched, addMaterial(matched, clearGlass(1.5F)), 2.0F, 3.0F, 11.0F);
    EXPECT_LT(differingShare(refracted(matched), block), 0.02);

    // A block of air within leaves two panes.
    gltf::Scene hollow = whole;
    addBlock(hollow, addMaterial(hollow, clearGlass(1.0F)), 2.0F, 3.0F, 11.0F);
    const LinearImage hole = refracted(hollow);
    gltf::Scene panes = squaresBehind();
    const int glass = addMaterial(panes, clearGlass(1.5F));
    addBlock(panes, glass, 1.0F, 2.0F, 12.0F);
    addBlock(panes, glass, 3.0F, 4.0F, 12.0F);
    EXPECT_LT(differingShare(hole, refracted(panes)), 0.02);
    EXPECT_GT(differingShare(hole, block), 0.2) << "the scene tells nothing";
    EXPECT_GT(differingShare(block, refracted(squaresBehind())), 0.2) << "nor does glass";
}

// A sample whose weight is below the bound sends no ray, and is counted.
TEST(Gates, FaintSamplesAreSkipped) {
    gltf::Scene scene = sceneWithCamera();
    materials::Material glossy;
    glossy["metallicFactor"] = 0.0F;
    glossy["roughnessFactor"] = 0.0F;
    addQuad(scene, glossy, {-2, -2, -1}, {4, 0, 0}, {0, 4, 0});
    RenderSetup setup = squareSetup(scene);
    compiler::CompileSettings settings;
    settings.strategies = package::kStrategyUber;
    const LoadedScene loaded(scene, settings);
    Renderer::Counters counters;
    loaded.render(package::kStrategyUber, setup, &counters);
    EXPECT_EQ(counters.of(package::kEffectReflection).rays, 32U * 32U);
    setup.frame.faintWeight = 0.5F;  // 4 % at normal incidence
    const LinearImage image = loaded.render(package::kStrategyUber, setup, &counters);
    EXPECT_EQ(counters.of(package::kEffectReflection).rays, 0U);
    EXPECT_EQ(counters.of(package::kEffectReflection).skippedFaint, 32U * 32U);
    EXPECT_FALSE(image.pixels.empty());
}

// A spot light misses half of the wall, and the range of a point light ends in front of it.
TEST(Gates, LightsAreKeptByConeRangeAndFacing) {
    gltf::Scene scene = sceneWithCamera();
    materials::Material wall;
    wall["metallicFactor"] = 0.0F;
    addQuad(scene, wall, {-2, -2, -1}, {4, 0, 0}, {0, 4, 0});
    gltf::Light light;
    light.type = gltf::LightType::Point;
    light.range = 0.5F;
    light.position = {0, 0, 0};
    scene.lights.push_back(light);
    light.type = gltf::LightType::Spot;
    light.range = 0.0F;
    light.direction = {0, 0, 1};  // away
    scene.lights.push_back(light);
    addDirectionalLight(scene, {0, 0, 1}, 1.0F);  // from behind
    RenderSetup setup = squareSetup(scene);
    setup.countsLight = true;
    compiler::CompileSettings settings;
    settings.strategies = package::kStrategyUber;
    settings.effects.named = package::kEffectShadow;
    const LoadedScene loaded(scene, settings);
    Renderer::Counters counters;
    loaded.render(package::kStrategyUber, setup, &counters);
    const Renderer::EffectCounters shadow = counters.of(package::kEffectShadow);
    EXPECT_EQ(shadow.rays, 0U);
    EXPECT_EQ(shadow.skippedRange, 32U * 32U);
    EXPECT_EQ(shadow.skippedCone, 32U * 32U);
    EXPECT_EQ(shadow.skippedFacing, 32U * 32U);
}

}  // namespace
