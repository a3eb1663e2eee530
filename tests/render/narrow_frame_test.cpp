// Frames with narrow records of samples and with a picture of 16-bit floats.
#include "render/rooms.h"
#include "render/scene_builder.h"
#include "render/ways.h"
#include "support/effect_bits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace {

using namespace glint;
using namespace glint::testing;

compiler::CompileSettings narrowSettings() {
    compiler::CompileSettings settings;
    settings.effects = {false, package::kAllEffects};
    settings.strategies = package::allStrategies();
    settings.tracers = package::kAllTracers;
    settings.sampleRecord = package::SampleRecordFormat::Packed;
    settings.plan.merge = compiler::MergePolicy::Family;
    return settings;
}

RenderSetup narrowSetup(const gltf::Scene& scene, std::uint32_t samples) {
    RenderSetup setup = defaultSetup(scene, 48, 32);
    setup.frame.maxReflectionRoughness = 1.0F;
    setup.samples = samples;
    return setup;
}

// Expects that all ways make one picture, and returns it.
LinearImage expectOnePicture(const gltf::Scene& scene, const compiler::CompileSettings& settings,
                             const RenderSetup& setup, std::uint32_t bounces) {
    std::optional<LinearImage> reference;
    forEachWay(scene, settings, [&](const LoadedScene& loaded, const Way& way) {
        RendererOptions options = optionsOf(way);
        options.bounces = bounces;
        Renderer::Counters counters;
        const LinearImage image = loaded.render(options, setup, &counters);
        EXPECT_GT(counters.rays, 0U) << nameOf(way);
        EXPECT_EQ(counters.orderErrors, 0U) << nameOf(way);
        if (!reference) {
            reference = image;
        }
        expectSameImage(image, *reference, nameOf(way));
    });
    return reference.value_or(LinearImage{});
}

// Returns the share of pixels of which a channel differs by more than `tolerance`.
double shareThatDiffers(const LinearImage& a, const LinearImage& b, float tolerance) {
    EXPECT_EQ(a.pixels.size(), b.pixels.size());
    std::size_t different = 0;
    for (std::size_t i = 0; i < std::min(a.pixels.size(), b.pixels.size()); ++i) {
        bool differs = false;
        for (std::size_t channel = 0; channel < 3; ++channel) {
            differs = differs || std::abs(a.pixels[i][channel] - b.pixels[i][channel]) >
                                     tolerance * std::max(1.0F, b.pixels[i][channel]);
        }
        different += differs ? 1 : 0;
    }
    return static_cast<double>(different) / static_cast<double>(a.pixels.size());
}

// A frame whose samples hold their hits has no records of hits.
TEST(PackedSamples, OfEveryWayAreOnePictureThatIsNearlyTheFullOne) {
    const gltf::Scene scene = roomBehindPane();
    const RenderSetup setup = narrowSetup(scene, 2);
    compiler::CompileSettings settings = narrowSettings();
    const LinearImage packed = expectOnePicture(scene, settings, setup, 1);
    settings.sampleRecord = package::SampleRecordFormat::Full;
    settings.strategies = package::kStrategyUber;
    settings.tracers = package::kTracerRayQuery;
    const LoadedScene full(scene, settings);
    const LinearImage exact = full.render(package::kStrategyUber, setup);
    // A ray that meets another surface, or a path that is refracted otherwise, may change a few pixels.
    EXPECT_LT(shareThatDiffers(packed, exact, 0.004F), 0.02);
}

// Paths and emissive lights need the start of a ray when its hit is shaded, so hits have records of their
// own.
TEST(PackedSamples, OfPathsAreOnePicture) {
    const gltf::Scene scene = roomBehindPane();
    compiler::CompileSettings settings = narrowSettings();
    settings.maxBounces = 3;
    settings.skyLight = compiler::SkyLight::On;
    settings.plan.merge = compiler::MergePolicy::All;
    expectOnePicture(scene, settings, narrowSetup(scene, 1), 3);
}

TEST(PackedSamples, WithDeferredShadowsInBandsAndInOneListAreTheSameToTheBit) {
    const gltf::Scene scene = roomBehindPane();
    compiler::CompileSettings settings = narrowSettings();
    settings.strategies = package::orderedStrategies();
    settings.tracers = package::kTracerRayQuery;
    settings.shadows = package::ShadowPlacement::Deferred;
    settings.plan.fallback = true;
    const LoadedScene loaded(scene, settings);
    EXPECT_TRUE(loaded.package().hitsInSamples());
    const RenderSetup setup = narrowSetup(scene, 1);
    for (const package::Strategy strategy : {package::kStrategyVisibility, package::kStrategySortedUber}) {
        RendererOptions options = optionsOf({strategy, package::kTracerRayQuery});
        const LinearImage whole = loaded.render(options, setup);
        options.bands = 3;
        options.accumulate = false;
        EXPECT_EQ(loaded.render(options, setup).pixels, whole.pixels);
        options.bands = 1;
        options.batchEffects = true;
        EXPECT_EQ(loaded.render(options, setup).pixels, whole.pixels);
    }
}

TEST(PackedSamples, SayHowPixelsFoundLight) {
    const gltf::Scene scene = roomBehindPane();
    compiler::CompileSettings settings = narrowSettings();
    settings.strategies = package::kStrategyUber;
    settings.tracers = package::kTracerRayQuery;
    RendererOptions options;
    options.strategy = package::kStrategyUber;
    options.width = 48;
    options.height = 32;
    options.accumulate = false;
    options.bands = 1;
    std::vector<std::vector<Renderer::PixelPath>> found;
    for (const auto record : {package::SampleRecordFormat::Packed, package::SampleRecordFormat::Full}) {
        settings.sampleRecord = record;
        const LoadedScene loaded(scene, settings);
        const auto renderer = loaded.makeRenderer(options);
        ASSERT_TRUE(renderer->render(narrowSetup(scene, 1).frame, 1));
        const auto paths = renderer->readCoverage(package::kEffectReflection);
        ASSERT_TRUE(paths);
        found.push_back(*paths);
    }
    std::size_t different = 0;
    for (std::size_t i = 0; i < found[0].size(); ++i) {
        different += found[0][i] != found[1][i] ? 1 : 0;
    }
    EXPECT_LE(different, found[0].size() / 200);
}

// The march reads the weights of other pixels, and moves the starts of rays.
TEST(PackedSamples, MarchOverTheScreenAsFullOnesDo) {
    const gltf::Scene scene = roomOfFewMaterials();
    compiler::CompileSettings settings;
    settings.strategies = package::kStrategyVisibility;
    settings.plan.merge = compiler::MergePolicy::All;
    RenderSetup setup = narrowSetup(scene, 1);
    setup.frame.screenSteps = 32;
    RendererOptions options = optionsOf({package::kStrategyVisibility, package::kTracerRayQuery});
    options.screenMarch = true;
    Renderer::Counters ofFull;
    const LinearImage full = LoadedScene(scene, settings).render(options, setup, &ofFull);
    settings.sampleRecord = package::SampleRecordFormat::Packed;
    Renderer::Counters ofPacked;
    const LinearImage packed = LoadedScene(scene, settings).render(options, setup, &ofPacked);
    EXPECT_LT(shareThatDiffers(packed, full, 0.004F), 0.02);
    const double found = ofFull.of(package::kEffectReflection).screenHits;
    EXPECT_GT(found, 0.0);
    EXPECT_NEAR(ofPacked.of(package::kEffectReflection).screenHits, found, 0.02 * found);
}

// Half floats have 11 significant bits. The light of the primary surfaces is rounded before that of effects
// is added, and a device may cut what it doesn't keep.
TEST(HalfPicture, IsWithinItsBitsOfTheFullOne) {
    const gltf::Scene scene = roomBehindPane();
    compiler::CompileSettings settings = narrowSettings();
    settings.sampleRecord = package::SampleRecordFormat::Full;
    settings.strategies = package::kStrategyUber;
    settings.plan.merge = compiler::MergePolicy::All;
    const LoadedScene loaded(scene, settings);
    const RenderSetup setup = narrowSetup(scene, 1);
    // First hits are shaded by compute shaders or by ray generation shaders.
    for (const Way& way : waysOf(package::kStrategyUber, package::kAllTracers)) {
        RendererOptions options = optionsOf(way);
        const LinearImage exact = loaded.render(options, setup);
        options.accumulate = false;
        options.picture = RendererOptions::PictureFormat::Half;
        const LinearImage half = loaded.render(options, setup);
        ASSERT_EQ(half.pixels.size(), exact.pixels.size());
        for (std::size_t i = 0; i < half.pixels.size(); ++i) {
            for (std::size_t channel = 0; channel < 3; ++channel) {
                const float value = exact.pixels[i][channel];
                ASSERT_NEAR(half.pixels[i][channel], value, value * 0x1p-9F + 1e-6F) << nameOf(way);
            }
        }
        options.bands = 3;
        EXPECT_EQ(loaded.render(options, setup).pixels, half.pixels) << nameOf(way);
    }
}

// Expects the value that a picture of bright light shows in a package with these layers.
void expectBrightPicture(std::vector<std::string> layers, float expected) {
    gltf::Scene scene = sceneWithCamera();
    materials::Material lamp;
    lamp["emissiveFactor"] = {1.0F, 1.0F, 1.0F};
    lamp["emissiveStrength"] = 1e6F;
    addQuad(scene, lamp, {-20, -20, -2}, {40, 0, 0}, {0, 40, 0});
    compiler::CompileSettings settings;
    settings.strategies = package::kStrategyUber;
    settings.layers = std::move(layers);
    const LoadedScene loaded(scene, settings);
    RendererOptions options;
    options.strategy = package::kStrategyUber;
    options.accumulate = false;
    options.picture = RendererOptions::PictureFormat::Half;
    Renderer::Counters counters;
    const LinearImage image = loaded.render(options, defaultSetup(scene, 16, 16), &counters);
    EXPECT_EQ(counters.nonFinite, 0U);
    for (const auto& pixel : image.pixels) {
        EXPECT_NEAR(pixel[0], expected, 1.0F);
    }
}

// Light above what half floats hold becomes the largest of them, and no pixel is taken for one without a
// number.
TEST(HalfPicture, HoldsBrightLight) {
    expectBrightPicture({}, 65504.0F);
}

// A module that writes layers of four half floats must not have that format twice.
TEST(HalfPicture, StaysFullBesideLayersOfHalfFloats) {
    expectBrightPicture({"albedo"}, 1e6F);
}

}  // namespace
