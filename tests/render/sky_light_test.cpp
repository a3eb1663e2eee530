// The sky as a light: its samples share the light with the rays that find it by chance, so that the mean is
// the same, and the noise of a small sun in a map is less.
#include "base/files.h"
#include "render/harness.h"
#include "render/light_pictures.h"
#include "render/scene_builder.h"
#include "render/ways.h"
#include "support/must.h"
#include "support/nightly.h"
#include "support/temporary_folder.h"

#include <glint/environment.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace {

using namespace glint;
using namespace glint::testing;
using compiler::SkyLight;

// By then paths have hardly any light left.
constexpr std::uint32_t kManyBounces = 16;

struct SkyWays {
    SkyLight sky = SkyLight::On;
    std::uint32_t bounces = 1;
    bool isMap = false;
    bool traces = true;  // effects send rays, which find the sky by chance
    package::ShadowThrough through = package::ShadowThrough::Alpha;
    std::uint32_t lights = 0;  // --lights
    bool compensates = false;  // --energy-compensation, which no ray of an effect finds
};

compiler::CompileSettings settingsOf(const SkyWays& ways) {
    compiler::CompileSettings settings;
    settings.strategies = package::kStrategyUber;
    settings.plan.merge = compiler::MergePolicy::All;
    settings.effects = {false, compiler::builtinEffects({"shadow"})};
    settings.effects.named |= ways.traces ? compiler::builtinEffects({"reflection", "indirect-diffuse"}) : 0;
    settings.effects.maxReflectionRoughness = 1.0F;
    settings.environmentMap = ways.isMap;
    settings.skyLight = ways.sky;
    // Emissive triangles are sampled where the sky is, and found by chance elsewhere.
    settings.emissiveLights =
        ways.sky == SkyLight::On ? compiler::EmissiveLights::On : compiler::EmissiveLights::Off;
    settings.shadowThrough = ways.through;
    settings.lightSamples = ways.lights;
    settings.maxBounces = ways.bounces;
    settings.energyCompensation = ways.compensates;
    return settings;
}

LoadedScene load(const gltf::Scene& scene, const compiler::CompileSettings& settings) {
    return LoadedScene(scene, settings, noLights);
}

RenderSetup setupOf(const gltf::Scene& scene, const Environment* map, std::uint32_t samples,
                    std::uint32_t seed) {
    RenderSetup setup = defaultSetup(scene, 16, 12);
    setup.frame.sky = uniformSky(1.0F);
    setup.frame.environment = map;
    setup.frame.environmentRotation = map != nullptr ? 0.7F : 0.0F;
    setup.frame.environmentIntensity = map != nullptr ? 0.5F : 1.0F;
    setup.frame.maxReflectionRoughness = 1.0F;
    setup.samples = samples;
    setup.frame.seed = seed;
    return setup;
}

LinearImage render(const LoadedScene& loaded, const RenderSetup& setup, std::uint32_t bounces) {
    RendererOptions options;
    options.strategy = package::kStrategyUber;
    options.bounces = bounces;
    return loaded.render(options, setup);
}

// By day a third of the samples is taken.
MeanEstimate estimate(const gltf::Scene& scene, const Environment* map, const SkyWays& ways,
                      std::uint32_t samples) {
    samples = test::nightly() ? samples : (samples + 2) / 3;
    const LoadedScene loaded = load(scene, settingsOf(ways));
    EXPECT_EQ(loaded.package().skyLight(), ways.sky == SkyLight::On);
    EXPECT_EQ(loaded.package().shadowThrough(), ways.through);
    return estimateMean(20, [&](std::uint32_t seed) {
        return render(loaded, setupOf(scene, map, samples, seed), ways.bounces);
    });
}

// Dim light, and a sun of four texels.
std::unique_ptr<Environment> sunnyMap() {
    LinearImage map{64, 32, {}};
    for (std::uint32_t i = 0; i < map.width * map.height; ++i) {
        const std::uint32_t x = i % map.width;
        const std::uint32_t y = i / map.width;
        const bool isSun = (x == 52 || x == 53) && (y == 7 || y == 8);
        map.pixels.push_back(isSun ? std::array<float, 4>{120.0F, 110.0F, 90.0F, 1.0F}
                                   : std::array<float, 4>{0.2F, 0.3F, 0.5F, 1.0F});
    }
    return must(Environment::create(sharedContext(), map, {.sampled = true}));
}

// A plane that fills the picture and sees half of the sky.
gltf::Scene plane(const materials::Material& material) {
    gltf::Scene scene = sceneWithCamera();
    addQuad(scene, material, {-50, -50, -2}, {100, 0, 0}, {0, 100, 0});
    return scene;
}

// A box with an opening above, as wide as its half, with a glossy wall and a sheet that scatters light to
// both sides.
gltf::Scene openBox() {
    gltf::Scene scene = sceneWithCamera();
    materials::Material glossy = mirrorMaterial();
    glossy["roughnessFactor"] = 0.45F;
    materials::Material sheet = matte(0.3F);
    sheet["diffuseTransmissionFactor"] = 0.5F;
    sheet.doubleSided = true;
    addQuad(scene, matte(0.6F), {-2, -1, 1}, {4, 0, 0}, {0, 0, -5});
    addQuad(scene, glossy, {-2, -1, -4}, {4, 0, 0}, {0, 2.5F, 0});
    addQuad(scene, matte(0.4F), {-2, -1, 1}, {0, 0, -5}, {0, 2.5F, 0});
    addQuad(scene, matte(0.5F), {2, -1, -4}, {0, 0, 5}, {0, 2.5F, 0});
    addQuad(scene, matte(0.6F), {-2, 1.5F, -4}, {2, 0, 0}, {0, 0, 5});
    addQuad(scene, sheet, {0.5F, -0.8F, -2.0F}, {0.8F, 0, -0.8F}, {0, 1.0F, 0});
    return scene;
}

// Under a uniform sky a matte plane has its albedo's light, whether effects send rays or not, and so has
// white metal of a gradient or of a map.
TEST(SkyLight, APlaneUnderAUniformSkyHasItsAlbedo) {
    for (const bool traces : {false, true}) {
        const SkyWays ways{SkyLight::On, 1, false, traces};
        const MeanEstimate seen = estimate(plane(matte(0.6F)), nullptr, ways, 64);
        expectSameMean(seen, {0.6, 0.0}, traces ? "with rays" : "without rays");
        EXPECT_FALSE(isSameMean({1.03 * seen.mean, seen.error}, {0.6, 0.0}))
            << "a fault of 3 % has to be found";
    }
    materials::Material metal = mirrorMaterial();
    metal["roughnessFactor"] = 0.5F;
    const SkyWays off{SkyLight::Off, 1, false, true};
    const SkyWays on{SkyLight::On, 1, false, true};
    expectSameMean(estimate(plane(metal), nullptr, on, 64), estimate(plane(metal), nullptr, off, 64),
                   "metal");
    // Rays and samples share the lobes of a dielectric, whose diffuse lobe depends on the direction of the
    // light.
    materials::Material dielectric = matte(0.8F);
    dielectric["specularFactor"] = 1.0F;
    dielectric["roughnessFactor"] = 0.5F;
    SkyWays shared = on;
    SkyWays apart = off;
    shared.compensates = apart.compensates = true;
    expectSameMean(estimate(plane(dielectric), nullptr, shared, 64),
                   estimate(plane(dielectric), nullptr, apart, 64), "dielectric");
    // What no ray brings: rough metal by samples, smooth metal by the ambient light.
    for (const float roughness : test::nightly() ? std::vector{0.7F, 0.1F} : std::vector{0.7F}) {
        metal["roughnessFactor"] = roughness;
        const SkyWays alone{SkyLight::On, 1, false, false};
        const SkyWays ambient{SkyLight::Off, 1, false, false};
        expectSameMean(estimate(plane(metal), nullptr, alone, 64),
                       estimate(plane(metal), nullptr, ambient, 1), "metal without rays", 5e-3);
    }
}

TEST(SkyLight, TheMeanIsThatOfChance) {
    const gltf::Scene scene = openBox();
    gltf::Scene withLamp = scene;
    materials::Material lamp = matte(0.0F);
    lamp["emissiveFactor"] = {1.0F, 0.6F, 0.3F};
    addQuad(withLamp, lamp, {-1.99F, -0.5F, -1.0F}, {0, 0, -1.5F}, {0, 1.0F, 0});
    const std::unique_ptr<Environment> map = sunnyMap();
    expectSameMean(estimate(scene, map.get(), {SkyLight::On, kManyBounces, true}, 96),
                   estimate(scene, map.get(), {SkyLight::Off, kManyBounces, true}, 384), "map with a sun");
    if (!test::nightly()) {
        return;
    }
    // With emissive triangles and a hierarchy of them.
    SkyWays sampled{SkyLight::On, kManyBounces};
    sampled.lights = 1;
    expectSameMean(estimate(withLamp, nullptr, sampled, 96),
                   estimate(withLamp, nullptr, {SkyLight::Off, kManyBounces}, 256), "uniform sky and a lamp");
}

// The opening with a pane of thin glass.
gltf::Scene glazedBox() {
    gltf::Scene scene = openBox();
    materials::Material glass;
    glass["metallicFactor"] = 0.0F;
    glass["roughnessFactor"] = 0.0F;
    glass["transmissionFactor"] = 1.0F;
    glass["baseColorFactor"] = {0.6F, 0.8F, 0.7F, 1.0F};
    glass.doubleSided = true;
    addQuad(scene, glass, {0, 1.5F, -4}, {2, 0, 0}, {0, 0, 5});
    return scene;
}

// With `glass` shadow rays pass the pane, and paths leave out what these bring.
TEST(SkyLight, LightThroughGlassCountsOnce) {
    const gltf::Scene scene = glazedBox();
    const MeanEstimate chance = estimate(scene, nullptr, {SkyLight::Off, kManyBounces}, 192);
    if (test::nightly()) {
        expectSameMean(estimate(scene, nullptr, {SkyLight::On, kManyBounces}, 96), chance,
                       "opaque to shadow rays");
    }
    const SkyWays through{SkyLight::On, kManyBounces, false, true, package::ShadowThrough::Glass};
    expectSameMean(estimate(scene, nullptr, through, 96), chance, "passed by shadow rays", 2e-3);
}

TEST(SkyLight, StrategiesAgree) {
    const gltf::Scene scene = glazedBox();
    const std::unique_ptr<Environment> map = sunnyMap();
    for (const bool isMap : {false, true}) {
        const package::ShadowThrough through =
            isMap ? package::ShadowThrough::Alpha : package::ShadowThrough::Glass;
        compiler::CompileSettings settings = settingsOf({SkyLight::On, 3, isMap, true, through});
        settings.shadows = isMap ? package::ShadowPlacement::Deferred : package::ShadowPlacement::Inline;
        std::optional<LinearImage> reference;
        forEachWay(
            scene, settings,
            [&](const LoadedScene& loaded, const Way& way) {
                RendererOptions options = optionsOf(way);
                options.bounces = 3;
                const LinearImage image =
                    loaded.render(options, setupOf(scene, isMap ? map.get() : nullptr, 4, 1));
                reference = reference.value_or(image);
                expectSameImage(image, *reference, nameOf(way));
            },
            noLights);
    }
}

// The error of a picture under a small sun is a fraction of that of chance at as many samples.
TEST(SkyLight, TheNoiseOfASunIsLess) {
    const gltf::Scene scene = openBox();
    const std::unique_ptr<Environment> map = sunnyMap();
    const LoadedScene chance = load(scene, settingsOf({SkyLight::Off, 4, true}));
    const LoadedScene sampled = load(scene, settingsOf({SkyLight::On, 4, true}));
    const LinearImage reference = render(sampled, setupOf(scene, map.get(), 384, 1), 4);
    std::array<double, 2> errors{};
    for (int seed = 0; seed < 3; ++seed) {
        errors[0] +=
            squaredDifference(render(chance, setupOf(scene, map.get(), 32, 30 + seed), 4), reference);
        errors[1] +=
            squaredDifference(render(sampled, setupOf(scene, map.get(), 32, 30 + seed), 4), reference);
    }
    std::printf("squared error: by chance %.4g, sampled %.4g\n", errors[0], errors[1]);
    EXPECT_LT(errors[1], 0.25 * errors[0]);
}

// A package without the light has none of its code, and `auto` decides by bounces and effects.
TEST(SkyLight, AutoDecidesByBouncesAndEffects) {
    const gltf::Scene scene = openBox();
    compiler::CompileSettings settings = settingsOf({SkyLight::Auto, 1});
    const auto samples = [&] {
        const auto plan = compiler::planPackage({&scene, 1}, settings);
        return plan && std::ranges::any_of(plan->modules, [](const compiler::PlannedModule& module) {
                   return module.text.find("#define GLINT_SKY_LIGHT 1") != std::string::npos;
               });
    };
    EXPECT_FALSE(samples());
    settings.skyLight = SkyLight::On;
    EXPECT_TRUE(samples());
    settings.skyLight = SkyLight::Auto;
    settings.maxBounces = 2;
    EXPECT_TRUE(samples());
    settings.effects.named = compiler::builtinEffects({"indirect-diffuse"});
    EXPECT_FALSE(samples()) << "without shadow rays";
    settings.effects.named = compiler::builtinEffects({"shadow", "reflection"});
    EXPECT_FALSE(samples()) << "without rays for the light that surfaces scatter";
    settings.effects.named = compiler::builtinEffects({"indirect-diffuse"});
    settings.skyLight = SkyLight::On;
    EXPECT_EQ(mustFail(compiler::planPackage({&scene, 1}, settings)).id, "sky-light");
}

// A host's own sky has no density: `auto` leaves it to rays, and `on` is refused.
TEST(SkyLight, AHostsOwnSkyIsNoLight) {
    const test::TemporaryFolder folder;
    constexpr const char* kText = R"(// A sky of one half.
#include "host/resources.glsl"
vec3 hostSky(vec3 direction) { return vec3(0.5); }
vec3 hostSkyAround(vec3 direction, float roughness) { return vec3(0.5); }
vec3 hostSkyIrradianceOverPi(vec3 normal) { return vec3(0.5); }
)";
    ASSERT_TRUE(base::writeFile(folder.path() / "sky.glsl", kText));
    const gltf::Scene scene = plane(matte(0.6F));
    compiler::CompileSettings settings = settingsOf({SkyLight::Auto, 2});
    settings.host = folder.path().string();
    const LoadedScene loaded = load(scene, settings);
    EXPECT_FALSE(loaded.package().skyLight());
    EXPECT_NEAR(meanOf(render(loaded, setupOf(scene, nullptr, 1, 1), 2)), 0.3, 1e-4);
    settings.skyLight = SkyLight::On;
    EXPECT_EQ(mustFail(compiler::planPackage({&scene, 1}, settings)).id, "sky-light");
}

// A map that was made without its distribution is refused.
TEST(SkyLight, AMapHasToBeSampled) {
    const gltf::Scene scene = openBox();
    const LoadedScene loaded = load(scene, settingsOf({SkyLight::On, 1, true}));
    const LinearImage image{1, 1, {{1.0F, 1.0F, 1.0F, 1.0F}}};
    const std::unique_ptr<Environment> map = must(Environment::create(sharedContext(), image, {}));
    EXPECT_FALSE(map->statistics().sampled);
    RendererOptions options;
    options.strategy = package::kStrategyUber;
    options.width = options.height = 8;
    const auto renderer = loaded.makeRenderer(options);
    FrameOptions frame = setupOf(scene, map.get(), 1, 1).frame;
    EXPECT_EQ(mustFail(renderer->record(VK_NULL_HANDLE, frame)).id, "environment-unsampled");
}

}  // namespace
