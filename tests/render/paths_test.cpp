// Paths of several bounces: every way to trace and shade them gives the same picture, and closed scenes have
// the radiance that their series say.
#include "frame/bounce_levels.h"
#include "render/hall.h"
#include "render/harness.h"
#include "render/light_pictures.h"
#include "render/rooms.h"
#include "render/scene_builder.h"
#include "render/ways.h"
#include "support/must.h"
#include "support/nightly.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

namespace {

using namespace glint;
using namespace glint::base;
using namespace glint::materials;
using namespace glint::gltf;
using namespace glint::compiler;
using namespace glint::testing;
using package::ShadowPlacement;

compiler::CompileSettings pathSettings(std::uint32_t bounces,
                                       package::Strategy strategy = package::kStrategyVisibility) {
    compiler::CompileSettings settings;
    settings.strategies = strategy;
    settings.maxBounces = bounces;
    settings.emissiveLights = compiler::EmissiveLights::Off;  // paths find emission by chance
    settings.skyLight = compiler::SkyLight::Off;              // and the sky
    settings.effects = {false, compiler::builtinEffects({"shadow", "reflection", "indirect-diffuse"})};
    settings.effects.maxReflectionRoughness = 1.0F;
    settings.plan.merge = compiler::MergePolicy::None;
    return settings;
}

// The same for scenes with glass.
compiler::CompileSettings glassSettings(std::uint32_t bounces) {
    compiler::CompileSettings settings = pathSettings(bounces);
    settings.effects.named |= compiler::builtinEffects({"refraction"});
    return settings;
}

RenderSetup pathSetup(const gltf::Scene& scene, std::uint32_t width, std::uint32_t height,
                      std::uint32_t samples) {
    RenderSetup setup = defaultSetup(scene, width, height);
    setup.samples = samples;
    setup.frame.maxReflectionRoughness = 1.0F;
    return setup;
}

RendererOptions pathOptions(std::uint32_t bounces,
                            package::Strategy strategy = package::kStrategyVisibility) {
    RendererOptions options;
    options.strategy = strategy;
    options.bounces = bounces;
    return options;
}

// Shared cases and deferred shadow rays change no picture either.
TEST(Paths, EveryStrategyAndTracerGivesTheSamePicture) {
    constexpr std::uint32_t kBounces = 3;
    const gltf::Scene scene = hallScene();
    const RenderSetup setup = pathSetup(scene, 32, 24, 2);
    compiler::CompileSettings settings = pathSettings(kBounces, package::kStrategyUber);
    settings.plan.keys.alpha = package::AlphaPolicy::Tested;
    std::optional<LinearImage> reference;
    for (const ShadowPlacement shadows : {ShadowPlacement::Inline, ShadowPlacement::Deferred}) {
        std::optional<Renderer::Counters> expected;  // shadow rays that are traced inline are not counted
        settings.shadows = shadows;
        settings.plan.merge =
            shadows == ShadowPlacement::Inline ? compiler::MergePolicy::None : compiler::MergePolicy::All;
        forEachWay(scene, settings, [&](const LoadedScene& loaded, const Way& way) {
            RendererOptions options = optionsOf(way);
            options.bounces = kBounces;
            Renderer::Counters counters;
            const LinearImage image = loaded.render(options, setup, &counters);
            reference = reference.value_or(image);
            expected = expected.value_or(counters);
            ASSERT_EQ(counters.raysOfBounces.size(), kBounces);
            EXPECT_GT(counters.raysOfBounces[1], 200U);
            EXPECT_GT(counters.raysOfBounces[2], 40U);
            expectSameImage(image, *reference, nameOf(way));
            EXPECT_EQ(counters.raysOfBounces, expected->raysOfBounces);
            EXPECT_EQ(counters.shadowRays, expected->shadowRays);
            EXPECT_EQ(counters.orderErrors, 0U);
        });
    }
}

// Without the light of sky and emissive triangles, and with both as lights.
TEST(Paths, OrderingsBinningsAndBatchesGiveTheSamePicture) {
    const gltf::Scene scene = roomOfFewMaterials();
    RenderSetup setup = pathSetup(scene, 24, 16, 2);
    for (const bool lights : {false, true}) {
        if (!lights && !test::nightly()) {
            continue;
        }
        compiler::CompileSettings settings = pathSettings(3);
        if (lights) {
            settings.strategies |= package::kStrategySortedUber;
            settings.emissiveLights = compiler::EmissiveLights::On;
            settings.skyLight = compiler::SkyLight::On;
        }
        const LoadedScene loaded(scene, settings);
        ASSERT_EQ(loaded.package().emission() != nullptr, lights);
        setup.frame.binning = FrameOptions::Binning::None;
        const LinearImage reference = loaded.render(pathOptions(3), setup);
        for (const package::Ordering ordering :
             {package::Ordering::WaveBallot, package::Ordering::LocalHistogram,
              package::Ordering::TileSort}) {
            const package::Strategy strategy = lights && ordering != package::Ordering::WaveBallot
                                                   ? package::kStrategySortedUber
                                                   : package::kStrategyVisibility;
            RendererOptions options = pathOptions(3, strategy);
            options.ordering = ordering;
            options.batchEffects = ordering == package::Ordering::LocalHistogram;
            options.checkOrder = true;
            setup.frame.binning = ordering == package::Ordering::TileSort ? FrameOptions::Binning::Octahedral
                                                                          : FrameOptions::Binning::Sign;
            Renderer::Counters counters;
            expectSameImage(loaded.render(options, setup, &counters), reference,
                            std::string(package::nameOf(ordering)) + (lights ? " with lights" : ""));
            EXPECT_EQ(counters.orderErrors, 0U);
        }
    }
}

// A package for one bounce has nothing of paths, and one for more makes the same picture if it is asked for
// one.
TEST(Paths, OneBounceIsThePictureWithoutPaths) {
    const gltf::Scene scene = roomOfFewMaterials();
    const LoadedScene plain(scene, pathSettings(1));
    const LoadedScene paths(scene, pathSettings(4));
    const auto hasPathRays = [](const LoadedScene& loaded) {
        return std::ranges::any_of(package::requiredModules(loaded.package().shape()),
                                   [](const auto& key) { return key.role == package::ModuleRole::PathRays; });
    };
    EXPECT_FALSE(hasPathRays(plain));
    EXPECT_TRUE(hasPathRays(paths));
    const RenderSetup setup = pathSetup(scene, 24, 16, 4);
    const LinearImage expected = plain.render(pathOptions(1), setup);
    const LinearImage image = paths.render(pathOptions(1), setup);
    expectSameImage(image, expected, "one of four bounces");
    // Frames may ask for fewer bounces than their renderer was made for.
    RenderSetup fewer = setup;
    fewer.frame.bounces = 1;
    expectSameImage(paths.render(pathOptions(4), fewer), expected, "a frame of one bounce");
    const LinearImage more = paths.render(pathOptions(4), setup);
    EXPECT_GT(std::abs(meanOf(more) - meanOf(expected)), 1e-3) << "further bounces change nothing";
}

TEST(Paths, MoreBouncesThanThePackageHasAreAnError) {
    const gltf::Scene scene = roomOfFewMaterials();
    const LoadedScene plain(scene, pathSettings(1));
    RendererOptions options = pathOptions(2);
    options.width = 8;
    options.height = 8;
    EXPECT_EQ(mustFail(Renderer::create(sharedContext(), plain.package(), plain.gpuScene(), options)).id,
              "package-bounces");
}

materials::Material diffuse(float albedo, float emission) {
    materials::Material material = matte(albedo);
    material["emissiveFactor"] = {emission, emission, emission};
    return material;
}

// Adds the six walls of a box that faces inwards, from `low` to `high`.
void addBox(gltf::Scene& scene, int material, gltf::Float3 low, gltf::Float3 high,
            const gltf::Matrix4& world) {
    const gltf::Float3 x{high[0] - low[0], 0, 0};
    const gltf::Float3 y{0, high[1] - low[1], 0};
    const gltf::Float3 z{0, 0, high[2] - low[2]};
    const gltf::Float3 minusX{-x[0], 0, 0};
    const auto add = [&](gltf::Float3 corner, gltf::Float3 right, gltf::Float3 up) {
        addInstance(scene, addMesh(scene, makeQuad(material, corner, right, up)), world);
    };
    add(low, z, x);                              // floor: z × x = y
    add({low[0], high[1], low[2]}, x, z);        // ceiling: x × z = -y
    add(low, x, y);                              // back: faces +z
    add({high[0], low[1], high[2]}, minusX, y);  // front: faces -z
    add(low, y, z);                              // left: y × z = x
    add({high[0], low[1], low[2]}, z, y);        // right: z × y = -x
}

gltf::Scene closedBox(float albedo, float emission, const gltf::Matrix4& world = scaling(1, 1, 1)) {
    gltf::Scene scene = sceneWithCamera();
    addBox(scene, addMaterial(scene, diffuse(albedo, emission)), {-1.13F, -0.77F, -2.31F},
           {1.29F, 1.07F, 0.93F}, world);
    return scene;
}

// In a closed box every wall of which emits e and reflects the share ρ, N bounces bring e Σ ρ^k with k from 0
// to N, and all bounces e / (1 - ρ).
TEST(Paths, AClosedBoxFollowsItsSeries) {
    constexpr float kAlbedo = 0.6F;
    constexpr float kEmission = 0.25F;
    const gltf::Scene scene = closedBox(kAlbedo, kEmission);
    const LoadedScene loaded(scene, pathSettings(package::kMaxBounces), noLights);
    RenderSetup setup = pathSetup(scene, 16, 16, 4);
    setup.frame.sky = uniformSky(0.0F);
    double sum = kEmission;
    double term = kEmission;
    const RendererOptions options = pathOptions(package::kMaxBounces);
    for (std::uint32_t bounces = 1; bounces <= 4; ++bounces) {
        term *= kAlbedo;
        sum += term;
        setup.frame.bounces = bounces;
        const LinearImage image = loaded.render(options, setup);
        // Up to the third bounce no path ends at random, so each pixel has the sum itself.
        if (bounces <= 3) {
            for (const auto& pixel : image.pixels) {
                ASSERT_NEAR(pixel[0], sum, 2e-5 * sum) << bounces << " bounces";
            }
        }
        EXPECT_NEAR(meanOf(image), sum, 0.01 * sum) << bounces << " bounces";
    }
    setup.frame.bounces = 0;
    setup.samples = 16;
    const double whole = meanOf(loaded.render(options, setup));
    std::printf("unlimited: %.5f of %.5f\n", whole, kEmission / (1.0 - kAlbedo));
    EXPECT_NEAR(whole, kEmission / (1.0 - kAlbedo), 0.01 * kEmission / (1.0 - kAlbedo));
}

std::unique_ptr<Renderer> rendererOf(const LoadedScene& loaded, const RenderSetup& setup) {
    RendererOptions options = pathOptions(package::kMaxBounces);
    options.width = setup.width;
    options.height = setup.height;
    return loaded.makeRenderer(options);
}

// A frame has passes for the bounces that paths of the frames before reached.
TEST(Paths, BouncesThatNoPathReachesAreNotRecorded) {
    const gltf::Scene scene = closedBox(0.4F, 0.25F);
    const LoadedScene loaded(scene, pathSettings(package::kMaxBounces), noLights);
    RenderSetup setup = pathSetup(scene, 8, 8, 1);
    setup.frame.sky = uniformSky(0.0F);
    const std::unique_ptr<Renderer> renderer = rendererOf(loaded, setup);
    std::vector<std::size_t> recorded;
    std::size_t reached = 0;
    const auto afterSample = [&] {
        const auto counters = renderer->counters();
        if (!counters) {
            return Status(counters.error());
        }
        const std::vector<std::uint32_t>& rays = counters->raysOfBounces;
        recorded.push_back(rays.size());
        const auto deepest =
            std::ranges::find_if(rays.rbegin(), rays.rend(), [](auto count) { return count > 0; });
        reached = std::max<std::size_t>(reached, rays.rend() - deepest);
        return okStatus();
    };
    must(renderer->renderSamples(setup.frame, 12, afterSample));
    EXPECT_EQ(recorded[0], package::kMaxBounces) << "nothing is known before the first frame";
    // A draw in sixteen records them all.
    const std::size_t sum = std::accumulate(recorded.begin() + 1, recorded.end(), std::size_t{0});
    EXPECT_LT(sum, (recorded.size() - 1) * package::kMaxBounces / 2)
        << "paths end after " << reached << " bounces";
    EXPECT_GT(*std::ranges::min_element(recorded), 3U);
    EXPECT_GT(reached, 3U);
    recorded.clear();
    setup.frame.recordAllBounces = true;
    must(renderer->renderSamples(setup.frame, 2, afterSample));
    EXPECT_EQ(recorded, std::vector<std::size_t>(2, package::kMaxBounces));
}

// Frames that know nothing of long paths have their light in the mean. Two seeds stand for each outcome of
// the draws.
TEST(Paths, BouncesThatAreLeftOutLoseNoLight) {
    constexpr float kAlbedo = 0.6F;
    constexpr float kEmission = 0.25F;
    const gltf::Scene scene = closedBox(kAlbedo, kEmission);
    const LoadedScene loaded(scene, pathSettings(package::kMaxBounces), noLights);
    RenderSetup setup = pathSetup(scene, 8, 8, 1);
    setup.frame.sky = uniformSky(0.0F);
    const std::unique_ptr<Renderer> renderer = rendererOf(loaded, setup);
    std::array<int, 16> wanted{};
    wanted.fill(2);
    double sum = 0.0;
    std::size_t frames = 0;
    std::size_t least = package::kMaxBounces;
    for (std::uint32_t seed = 0; frames < 2 * wanted.size(); ++seed) {
        int& outcome = wanted[bounceBits(0, seed) % wanted.size()];
        if (outcome == 0) {
            continue;
        }
        --outcome;
        ++frames;
        // After these the renderer knows of two bounces alone.
        FrameOptions few = setup.frame;
        few.bounces = 1;
        must(renderer->renderSamples(few, BounceLevels::kRemembered));
        setup.frame.seed = seed;
        const auto image = renderer->render(setup.frame);
        ASSERT_TRUE(image.ok());
        sum += meanOf(*image);
        least = std::min(least, renderer->counters()->raysOfBounces.size());
    }
    EXPECT_EQ(least, 2U);
    const double mean = sum / static_cast<double>(frames);
    const double truth = kEmission / (1.0 - kAlbedo);
    std::printf("%.5f of %.5f\n", mean, truth);
    EXPECT_NEAR(mean, truth, 0.015 * truth);
}

// Returns a rotation about (1, 2, 3), which leaves no coordinate of a box as it was, and a translation.
gltf::Matrix4 placement(double angle, const double (&place)[3]) {
    const double length = std::sqrt(14.0);
    const double axis[3] = {1.0 / length, 2.0 / length, 3.0 / length};
    gltf::Matrix4 matrix{};
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) {
            const int third = 3 - row - column;
            const double sign = (column - row + 3) % 3 == 1 ? -1.0 : 1.0;
            matrix[4 * column + row] =
                axis[row] * axis[column] * (1.0 - std::cos(angle)) +
                (row == column ? std::cos(angle) : sign * axis[third] * std::sin(angle));
        }
    }
    std::copy(std::begin(place), std::end(place), &matrix[12]);
    matrix[15] = 1.0;
    return matrix;
}

// Every ray in a closed box finds a wall, also from its edges and corners, where rounding may put a point of
// one wall behind another.
TEST(Paths, AClosedBoxLosesNoRay) {
    // Far from the origin floats are coarse.
    constexpr double kPlace[3] = {1000.0, 300.0, 700.0};
    const gltf::Scene scene = closedBox(1.0F, 0.0F, placement(0.7, kPlace));
    const LoadedScene loaded(scene, pathSettings(16), noLights);
    RenderSetup setup = pathSetup(scene, 256, 256, 1);
    setup.frame.camera.position = {1000.0F, 300.0F, 700.0F};
    setup.frame.sky = uniformSky(1.0F);
    std::uint64_t rays = 0;
    std::uint64_t lost = 0;
    const std::uint32_t seeds = test::nightly() ? 4 : 1;
    for (std::uint32_t seed = 0; seed < seeds; ++seed) {
        setup.frame.seed = seed;
        Renderer::Counters counters;
        ASSERT_FALSE(loaded.render(pathOptions(16), setup, &counters).pixels.empty());
        rays += counters.rays;
        lost += counters.bucketCounts[0];
    }
    std::printf("%llu rays, %llu lost\n", static_cast<unsigned long long>(rays),
                static_cast<unsigned long long>(lost));
    EXPECT_GE(rays, seeds * 1000000U);
    EXPECT_EQ(lost, 0U);
}

// What a coat with a turned normal sends to the other side of its triangle is reflected there, so that no ray
// leaves a closed box.
TEST(Paths, CoatsWithTurnedNormalsSendNoRayThroughTheirSurface) {
    gltf::Scene scene = sceneWithCamera();
    materials::Material coated = diffuse(0.5F, 0.0F);
    coated["clearcoatFactor"] = 1.0F;
    coated["clearcoatRoughnessFactor"] = 0.2F;
    // 60° towards u.
    coated.texture("clearcoatNormalTexture").texture = addTexture(scene, 1, 1, {238, 128, 191, 255});
    addBox(scene, addMaterial(scene, coated), {-1, -1, -2}, {1, 1, 1}, scaling(1, 1, 1));
    const LoadedScene loaded(scene, pathSettings(4), noLights);
    RenderSetup setup = pathSetup(scene, 32, 32, 1);
    setup.frame.sky = uniformSky(1.0F);
    Renderer::Counters counters;
    ASSERT_FALSE(loaded.render(pathOptions(4), setup, &counters).pixels.empty());
    ASSERT_EQ(counters.raysOfBounces.size(), 4U);
    EXPECT_GT(counters.raysOfBounces[3], 100U);
    EXPECT_EQ(counters.bucketCounts[0], 0U);
}

// White surfaces under a uniform sky are as bright as the sky, whatever their lobes are.
TEST(Paths, WhiteSurfacesVanishInAUniformSky) {
    gltf::Scene scene = sceneWithCamera();
    materials::Material rough = diffuse(1.0F, 0.0F);
    rough["specularFactor"] = 1.0F;
    rough["roughnessFactor"] = 0.5F;
    materials::Material metal = mirrorMaterial();
    metal["roughnessFactor"] = 0.4F;
    materials::Material wall = diffuse(1.0F, 0.0F);
    wall["transmissionFactor"] = 1.0F;
    wall["specularFactor"] = 1.0F;
    wall["roughnessFactor"] = 0.0F;
    wall.doubleSided = true;
    const auto add = [&](const materials::Material& material, gltf::Float3 corner, gltf::Float3 right,
                         gltf::Float3 up) { addQuad(scene, material, corner, right, up); };
    add(rough, {-3, -1, 1}, {6, 0, 0}, {0, 0, -5});
    add(mirrorMaterial(), {-3, -1, -1}, {2, 0, -3}, {0, 3, 0});
    add(metal, {1, -1, -4}, {2, 0, 3}, {0, 3, 0});
    add(diffuse(1.0F, 0.0F), {-1, -1, -4}, {2, 0, 0}, {0, 3, 0});
    add(wall, {-0.8F, -0.9F, -2}, {1.6F, 0, 0}, {0, 1.2F, 0});
    const LoadedScene loaded(scene, glassSettings(package::kMaxBounces), noLights);
    RenderSetup setup = pathSetup(scene, 24, 24, 16);
    setup.frame.sky = uniformSky(1.0F);
    for (const std::uint32_t bounces : {1U, 2U, 4U, package::kMaxBounces}) {
        setup.frame.bounces = bounces;
        const LinearImage image = loaded.render(pathOptions(package::kMaxBounces), setup);
        double worst = 0.0;
        for (const auto& pixel : image.pixels) {
            worst = std::max(worst, std::abs(pixel[1] - 1.0));
        }
        std::printf("%u bounces: mean %.5f, worst pixel off by %.4f\n", bounces, meanOf(image), worst);
        EXPECT_NEAR(meanOf(image), 1.0, 0.01) << bounces << " bounces";
    }
}

// A mirror shows a block of glass, whose single-sided surface the paths enter and leave. `color` is what one
// metre of the glass lets through. With `holdsClear` the middle half of it is clear glass of the same index.
double brightnessOfMirroredGlass(gltf::Float3 color, float roughness = 0.0F, bool holdsClear = false) {
    gltf::Scene scene = sceneWithCamera();
    const int mirror = addMaterial(scene, mirrorMaterial());
    addQuad(scene, mirror, {-1, -1, -1}, {2, 0, 0}, {0, 2, 0});
    materials::Material glass = diffuse(1.0F, 0.0F);
    glass["specularFactor"] = 1.0F;
    glass["roughnessFactor"] = roughness;
    glass["transmissionFactor"] = 1.0F;
    glass["thicknessFactor"] = 1.0F;
    glass["attenuationDistance"] = 1.0F;
    glass["attenuationColor"] = {color[0], color[1], color[2]};
    // With its corners exchanged the box faces outwards. It is behind the camera.
    addBox(scene, addMaterial(scene, glass), {5, 5, 2}, {-5, -5, 1}, scaling(1, 1, 1));
    if (holdsClear) {
        glass["attenuationColor"] = {1, 1, 1};
        addBox(scene, addMaterial(scene, glass), {4, 4, 1.75F}, {-4, -4, 1.25F}, scaling(1, 1, 1));
    }
    const LoadedScene loaded(scene, glassSettings(32), noLights);
    RenderSetup setup = pathSetup(scene, 16, 16, 64);
    setup.frame.sky = uniformSky(1.0F);
    Renderer::Counters counters;
    const double mean = meanOf(loaded.render(pathOptions(32), setup, &counters));
    EXPECT_GT(counters.raysOfBounces.at(2), 100U) << "the glass sends no rays";
    return mean;
}

TEST(Paths, ClearGlassIsWhiteInAUniformSky) {
    const double mean = brightnessOfMirroredGlass({1, 1, 1});
    std::printf("mean %.5f\n", mean);
    EXPECT_NEAR(mean, 1.0, 0.01);
}

TEST(Paths, RoughGlassIsWhiteInAUniformSky) {
    const double mean = brightnessOfMirroredGlass({1, 1, 1}, 0.7F);
    std::printf("mean %.5f\n", mean);
    EXPECT_NEAR(mean, 1.0, 0.01);
}

// A metre of the glass lets half of the light through. Rays that enter at once take a little more than a
// metre, and Fresnel's reflection in front, about a twenty-fifth, does not pass.
TEST(Paths, GlassAbsorbsOverTheRealDistance) {
    const double mean = brightnessOfMirroredGlass({0.5F, 0.5F, 0.5F});
    std::printf("mean %.5f\n", mean);
    EXPECT_GT(mean, 0.45);
    EXPECT_LT(mean, 0.55);
}

// Half a metre of the glass lets 0.71 of the light through. A path that leaves the clear glass is in the
// other one again, and nothing is reflected between the two.
TEST(Paths, VolumesWithinVolumesAreLeftForTheOneAround) {
    const double mean = brightnessOfMirroredGlass({0.5F, 0.5F, 0.5F}, 0.0F, true);
    std::printf("mean %.5f\n", mean);
    EXPECT_GT(mean, 0.66);
    EXPECT_LT(mean, 0.73);
}

}  // namespace
