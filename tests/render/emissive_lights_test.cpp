// Triangles that emit light as lights: their samples share the light with the rays that find them by chance,
// so that the mean is the same, and the noise is less.
#include "render/harness.h"
#include "render/light_pictures.h"
#include "render/moving_scenes.h"
#include "render/scene_builder.h"
#include "render/ways.h"
#include "resolve/light.h"
#include "support/must.h"
#include "support/nightly.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace {

using namespace glint;
using namespace glint::testing;
using compiler::EmissiveLights;

using Double3 = std::array<double, 3>;

struct Ways {
    EmissiveLights emissive = EmissiveLights::On;
    std::optional<std::uint32_t> lights = 1;
    std::uint32_t bounces = 1;
    bool traces = true;  // effects send rays, which find emissive surfaces by chance
    std::uint32_t strategies = package::kStrategyUber;
    package::ShadowPlacement shadows = package::ShadowPlacement::Inline;
    package::ShadowThrough through = package::ShadowThrough::Alpha;
};

compiler::CompileSettings settingsOf(const Ways& ways) {
    compiler::CompileSettings settings;
    settings.strategies = ways.strategies;
    settings.shadows = ways.shadows;
    settings.shadowThrough = ways.through;
    settings.plan.merge = compiler::MergePolicy::All;
    settings.effects = {false, compiler::builtinEffects({"shadow"})};
    settings.effects.named |= ways.traces ? compiler::builtinEffects({"reflection", "indirect-diffuse"}) : 0;
    settings.effects.maxReflectionRoughness = 1.0F;
    settings.plan.keys.alpha = package::AlphaPolicy::Stochastic;
    settings.emissiveLights = ways.emissive;
    settings.lightSamples = ways.lights;
    settings.maxBounces = ways.bounces;
    // No ray of an effect brings what compensation adds, so that chance would not find it.
    settings.energyCompensation = false;
    settings.textureLod = compiler::TextureLod::Mip0;
    return settings;
}

LoadedScene load(const gltf::Scene& scene, const Ways& ways) {
    return LoadedScene(scene, settingsOf(ways), noLights);
}

RenderSetup setupOf(const gltf::Scene& scene, std::uint32_t samples, std::uint32_t seed,
                    std::uint32_t height = 12) {
    RenderSetup setup = defaultSetup(scene, 16, height);
    setup.frame.sky = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    setup.frame.maxReflectionRoughness = 1.0F;
    setup.samples = samples;
    setup.frame.seed = seed;
    return setup;
}

LinearImage render(const LoadedScene& scene, const RenderSetup& setup, const Ways& ways = {}) {
    RendererOptions options;
    options.strategy = package::kStrategyUber;
    options.bounces = ways.bounces;
    return scene.render(options, setup);
}

// A black surface that emits light.
materials::Material lamp(gltf::Float3 color, float strength) {
    materials::Material material = matte(0.0F);
    material["emissiveFactor"] = {color[0], color[1], color[2]};
    material["emissiveStrength"] = strength;
    return material;
}

MeanEstimate estimate(const LoadedScene& scene, const gltf::Scene& source, const Ways& ways,
                      std::uint32_t samples) {
    return estimateMean(
        20, [&](std::uint32_t seed) { return render(scene, setupOf(source, samples, seed), ways); });
}

Double3 minus(const Double3& a, const Double3& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

double dotOf(const Double3& a, const Double3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// The irradiance that a polygon of radiance 1 brings to a surface which sees all of it: Lambert's formula,
// 1/2 Σ θ n·Γ over the edges, with the angle θ that an edge fills and the normal Γ of that angle's plane.
double polygonIrradiance(const Double3& point, const Double3& normal, const std::vector<Double3>& corners) {
    double sum = 0.0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Double3 a = minus(corners[i], point);
        const Double3 b = minus(corners[(i + 1) % corners.size()], point);
        const Double3 cross{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
        const double length = std::sqrt(dotOf(cross, cross));
        sum += std::atan2(length, dotOf(a, b)) * dotOf(normal, cross) / length;
    }
    return 0.5 * std::abs(sum);
}

// A wall at z = -4 below a lamp that faces down.
TEST(EmissiveLights, AQuadLightsAWallByItsFormFactor) {
    constexpr double kAlbedo = 0.5;
    constexpr double kRadiance = 3.0;
    gltf::Scene scene = sceneWithCamera();
    addQuad(scene, matte(kAlbedo), {-8, -8, -4}, {16, 0, 0}, {0, 16, 0});
    // Its solid angle is large for some pixels, and small for others.
    const std::vector<Double3> corners{{-1, 0.5, -3.8}, {1, 0.5, -3.8}, {1, 0.5, -2.6}, {-1, 0.5, -2.6}};
    addQuad(scene, lamp({1, 1, 1}, kRadiance), {-1, 0.5F, -3.8F}, {2, 0, 0}, {0, 0, 1.2F});
    for (const bool traces : {false, true}) {
        for (const std::uint32_t lights : {0U, 1U}) {
            if (!test::nightly() && traces != (lights > 0)) {
                continue;
            }
            const Ways ways{EmissiveLights::On, lights, 1, traces};
            const LoadedScene loaded = load(scene, ways);
            // A choice of one triangle has noise of its own.
            const RenderSetup setup = setupOf(scene, lights == 0 ? 256 : 1024, 3, 16);
            const LinearImage image = loaded.render(package::kStrategyUber, setup);
            double worst = 0.0;
            double sum = 0.0;
            double expected = 0.0;
            // The lower half, which the lamp does not hide.
            for (std::uint32_t y = 9; y < 16; ++y) {
                for (std::uint32_t x = 0; x < 16; ++x) {
                    double pixel = 0.0;
                    for (int i = 0; i < 16; ++i) {
                        const double u = (x + (i % 4 + 0.5) / 4.0) / 8.0 - 1.0;
                        const double v = 1.0 - (y + (i / 4 + 0.5) / 4.0) / 8.0;
                        pixel += polygonIrradiance({4.0 * u, 4.0 * v, -4.0}, {0, 0, 1}, corners) / 16.0;
                    }
                    pixel *= kRadiance * kAlbedo / std::numbers::pi;
                    const double found = image.pixels[y * 16 + x][1];
                    worst = std::max(worst, std::abs(found / pixel - 1.0));
                    sum += found;
                    expected += pixel;
                }
            }
            std::printf("rays %d, lights %u: mean off by %.5f, worst pixel by %.4f\n", traces ? 1 : 0, lights,
                        sum / expected - 1.0, worst);
            EXPECT_NEAR(sum, expected, 4e-3 * expected);
            EXPECT_LT(worst, 0.05);
        }
    }
}

// Thin glass that reflects nothing.
constexpr std::array<double, 3> kTint{0.25, 0.5, 0.75};

materials::Material tintedGlass() {
    materials::Material glass = matte(1.0F);
    glass["baseColorFactor"] = {0.25F, 0.5F, 0.75F, 1.0F};
    glass["roughnessFactor"] = 0.0F;
    glass["transmissionFactor"] = 1.0F;
    glass.doubleSided = true;
    return glass;
}

// A pane between the lamp and the wall takes its tint from the light, whether paths pass the pane or not:
// what shadow rays bring through it, paths leave out.
TEST(EmissiveLights, LightPassesAPaneOnce) {
    constexpr double kAlbedo = 0.5;
    constexpr double kRadiance = 3.0;
    gltf::Scene scene = sceneWithCamera();
    addQuad(scene, matte(kAlbedo), {-8, -8, -4}, {16, 0, 0}, {0, 16, 0});
    const std::vector<Double3> corners{{-1, 0.5, -3.8}, {1, 0.5, -3.8}, {1, 0.5, -2.6}, {-1, 0.5, -2.6}};
    addQuad(scene, lamp({1, 1, 1}, kRadiance), {-1, 0.5F, -3.8F}, {2, 0, 0}, {0, 0, 1.2F});
    addQuad(scene, tintedGlass(), {-4, 0.4F, -4}, {8, 0, 0}, {0, 0, 2.5F});
    double expected = 0.0;
    for (int y = 36; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            const Double3 point{4.0 * ((x + 0.5) / 32.0 - 1.0), 4.0 * (1.0 - (y + 0.5) / 32.0), -4.0};
            expected +=
                polygonIrradiance(point, {0, 0, 1}, corners) * kRadiance * kAlbedo / std::numbers::pi / 16.0;
        }
    }
    for (const std::uint32_t bounces : {1U, 3U}) {
        for (const std::uint32_t lights : {0U, 1U}) {
            if (!test::nightly() && (bounces > 1) != (lights > 0)) {
                continue;
            }
            Ways ways{EmissiveLights::On, lights, bounces};
            ways.through = package::ShadowThrough::Glass;
            const LoadedScene loaded = load(scene, ways);
            EXPECT_EQ(loaded.package().shadowThrough(), ways.through);
            const LinearImage image = render(loaded, setupOf(scene, lights == 0 ? 128 : 256, 3, 16), ways);
            for (std::size_t channel = 0; channel < 3; ++channel) {
                double sum = 0.0;
                for (std::size_t i = std::size_t{9} * 16; i < image.pixels.size(); ++i) {
                    sum += image.pixels[i][channel];
                }
                std::printf("%u bounces, lights %u, channel %zu: off by %.5f\n", bounces, lights, channel,
                            sum / (kTint[channel] * expected) - 1.0);
                EXPECT_NEAR(sum, kTint[channel] * expected, 0.01 * kTint[channel] * expected);
            }
        }
    }
}

// The lower half of a picture.
double lowerMean(const LinearImage& image) {
    double sum = 0.0;
    for (std::size_t i = image.pixels.size() / 2; i < image.pixels.size(); ++i) {
        sum += image.pixels[i][0] + image.pixels[i][1] + image.pixels[i][2];
    }
    return sum / (1.5 * static_cast<double>(image.pixels.size()));
}

// Where a pane hides a part of a lamp, light that passes it counts whole in samples, and samples and rays
// share the rest. Paths by chance pass the pane themselves.
TEST(EmissiveLights, HalfAPaneHasTheMeanOfChance) {
    gltf::Scene scene = sceneWithCamera();
    materials::Material glossy = mirrorMaterial();
    glossy["roughnessFactor"] = 0.5F;
    addQuad(scene, glossy, {-8, -8, -4}, {16, 0, 0}, {0, 16, 0});
    addQuad(scene, lamp({1, 1, 1}, 3.0F), {-2, 0.7F, -3.9F}, {4, 0, 0}, {0, 0, 2.5F});
    addQuad(scene, tintedGlass(), {-8, 0.4F, -4}, {8, 0, 0}, {0, 0, 4});
    Ways ways{EmissiveLights::On, 1, 2};
    ways.through = package::ShadowThrough::Glass;
    const Ways chance{EmissiveLights::Off, 0, 3};
    const LoadedScene sampled = load(scene, ways);
    const LoadedScene byChance = load(scene, chance);
    const double mean = lowerMean(render(sampled, setupOf(scene, 512, 5, 16), ways));
    const double expected = lowerMean(render(byChance, setupOf(scene, 2048, 6, 16), chance));
    std::printf("half a pane: %.5f, by chance %.5f\n", mean, expected);
    EXPECT_GT(expected, 0.01);
    EXPECT_NEAR(mean, expected, 0.01 * expected);
}

// A mirror takes no samples of lights, so its rays bring all that is behind a pane.
TEST(EmissiveLights, AMirrorShowsALampBehindAPane) {
    gltf::Scene scene = sceneWithCamera();
    addQuad(scene, mirrorMaterial(), {-50, -50, -2}, {100, 0, 0}, {0, 100, 0});
    addQuad(scene, tintedGlass(), {50, -50, 0.5F}, {-100, 0, 0}, {0, 100, 0});
    addQuad(scene, lamp({1, 1, 1}, 2.0F), {2, -2, 1}, {-4, 0, 0}, {0, 4, 0});
    Ways ways{EmissiveLights::On, 0, 2};
    ways.through = package::ShadowThrough::Glass;
    const LoadedScene loaded = load(scene, ways);
    const LinearImage image = render(loaded, setupOf(scene, 64, 1, 16), ways);
    for (std::size_t channel = 0; channel < 3; ++channel) {
        double sum = 0.0;
        for (const auto& pixel : image.pixels) {
            sum += pixel[channel] / 256.0;
        }
        // 4 m at a distance of 5 m, of 10 m that the picture shows there.
        EXPECT_NEAR(sum, 2.0 * kTint[channel] * 0.16, 0.02 * kTint[channel] * 0.32);
    }
}

// A floor, a glossy wall, a sheet that lets light through, and two lamps: a textured one that shines on both
// sides, of which half is black, and a small one that shines down and is partly clear.
gltf::Scene litRoom() {
    gltf::Scene scene = sceneWithCamera();
    materials::Material glossy = mirrorMaterial();
    glossy["roughnessFactor"] = 0.45F;
    materials::Material sheet = matte(0.3F);
    sheet["diffuseTransmissionFactor"] = 0.5F;
    sheet.doubleSided = true;
    materials::Material panel = lamp({1.0F, 0.8F, 0.5F}, 2.0F);
    panel.doubleSided = true;
    std::vector<std::uint8_t> texels;
    for (int i = 0; i < 16; ++i) {
        const std::uint8_t value = i % 4 < 2 ? 0 : i % 3 == 0 ? 255 : 160;
        texels.insert(texels.end(), {value, value, 200, 255});
        texels[texels.size() - 2] = value == 0 ? 0 : 200;
    }
    panel.texture("emissiveTexture").texture = addTexture(scene, 4, 4, texels);
    materials::Material small = lamp({0.5F, 0.6F, 1.0F}, 30.0F);
    small.alphaMode = materials::AlphaMode::Blend;
    small["baseColorFactor"] = {0.0F, 0.0F, 0.0F, 0.7F};
    addQuad(scene, matte(0.6F), {-4, -1, 0}, {8, 0, 0}, {0, 0, -8});
    addQuad(scene, glossy, {-4, -1, -5}, {8, 0, 0}, {0, 5, 0});
    addQuad(scene, sheet, {1, -0.8F, -2.5F}, {1, 0, -1}, {0, 1.2F, 0});
    // The camera sees neither lamp, so that their own pictures add no noise.
    addQuad(scene, panel, {-1.5F, 2, -1.5F}, {1.2F, 0, 0.4F}, {0, 0.6F, 0.5F});
    addQuad(scene, small, {0.9F, 2.2F, -1.2F}, {0.3F, 0, 0}, {0, 0, 0.3F});
    return scene;
}

// With one bounce, hits take the light of lamps that two bounces find by chance.
TEST(EmissiveLights, TheMeanIsThatOfChance) {
    const gltf::Scene scene = litRoom();
    const Ways chance{EmissiveLights::Off, 0, 2};
    const LoadedScene byChance = load(scene, chance);
    EXPECT_EQ(byChance.package().emission(), nullptr);
    const MeanEstimate expected = estimate(byChance, scene, chance, 512);
    for (const std::uint32_t lights : test::nightly() ? std::vector{0U, 1U} : std::vector{1U}) {
        const Ways ways{EmissiveLights::On, lights, 1};
        const LoadedScene sampled = load(scene, ways);
        EXPECT_NE(sampled.package().emission(), nullptr);
        expectSameMean(estimate(sampled, scene, ways, 64), expected, std::to_string(lights) + " lights");
    }
    if (!test::nightly()) {
        return;
    }
    // Three bounces by chance are two with samples.
    const Ways further{EmissiveLights::Off, 0, 3};
    const LoadedScene third = load(scene, further);
    const Ways ways{EmissiveLights::On, 1, 2};
    const LoadedScene sampled = load(scene, ways);
    expectSameMean(estimate(sampled, scene, ways, 64), estimate(third, scene, further, 512), "two bounces");
}

// Whether a ray stops at alphaMode BLEND depends on its last bits, so the lamps are opaque here.
TEST(EmissiveLights, StrategiesAgree) {
    gltf::Scene scene = litRoom();
    for (materials::Material& material : scene.materials) {
        material.alphaMode = materials::AlphaMode::Opaque;
    }
    std::optional<LinearImage> reference;
    const auto expectSame = [&](const LoadedScene& loaded, const Way& way) {
        RendererOptions options = optionsOf(way);
        options.bounces = 2;
        const LinearImage image = loaded.render(options, setupOf(scene, 4, 1));
        reference = reference ? reference : image;
        expectSameImage(image, *reference, nameOf(way));
    };
    Ways ways{EmissiveLights::On, 2, 2, true, package::allStrategies(), package::ShadowPlacement::Inline};
    compiler::CompileSettings settings = settingsOf(ways);
    settings.plan.merge = test::nightly() ? compiler::MergePolicy::None : compiler::MergePolicy::All;
    forEachWay(scene, settings, expectSame, noLights);
    settings.shadows = package::ShadowPlacement::Deferred;
    settings.strategies = package::kStrategyUber;
    settings.tracers = package::kTracerRayQuery;
    for (const Way& way : waysOf(settings.strategies, settings.tracers)) {
        const LoadedScene loaded(scene, settings, noLights);
        expectSame(loaded, way);
    }
}

// One lamp is moved, and another one changes its shape.
TEST(EmissiveLights, LampsThatMoveAreFollowed) {
    gltf::Scene scene = sceneWithCamera();
    const int shining = addMaterial(scene, lamp({1, 1, 1}, 8.0F));
    addQuad(scene, matte(0.5F), {-4, -1, 0}, {8, 0, 0}, {0, 0, -8});
    addQuad(scene, shining, {-1.5F, 0.2F, -4}, {0.6F, 0, 0}, {0, 0, 0.6F});
    gltf::Primitive sheet = makeQuad(shining, {1, -0.5F, -4}, {0.5F, 0, 0}, {0, 0.5F, 0});
    gltf::Scene still = scene;
    sheet.targets.resize(1);
    gltf::Primitive bent = sheet;
    for (std::size_t i = 0; i < sheet.positions.size(); ++i) {
        const gltf::Float3 change{-0.4F, 0.3F * static_cast<float>(i), 0.5F};
        sheet.targets[0].positions.push_back(change);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            bent.positions[i][axis] += change[axis];
        }
    }
    sheet.normals.clear();
    bent.normals.clear();
    bent.targets.clear();
    addInstance(still, addMesh(still, bent));
    addInstance(scene, addMesh(scene, sheet));
    scene.meshes.back().weights = {0.0};
    scene.nodes.back().weights = {0.0};
    for (const std::uint32_t lights : {0U, 1U}) {
        const Ways ways{EmissiveLights::On, lights, 1, false};
        const LoadedScene expected = load(still, ways);
        std::vector<InstanceView> instances;
        const LoadedScene moving(scene, settingsOf(ways), [&](session::SceneViewData& data) {
            data.lights.clear();
            data.moves = true;
            instances = data.instances;
            data.instances[1].objectToWorld[3] += 50.0F;
        });
        constexpr std::array<float, 1> kBent{1.0F};
        instances[2].morphWeights = kBent;
        must(moving.gpuScene().updateAndWait({instances, {}}));
        expectSameMean(estimate(moving, scene, ways, 32), estimate(expected, still, ways, 32), "moved");
        instances[1].visible = instances[2].visible = false;
        ASSERT_TRUE(moving.gpuScene().updateAndWait({instances, {}}));
        EXPECT_EQ(meanOf(render(moving, setupOf(scene, 2, 1))), 0.0) << "hidden";
    }
}

// Samples of a lamp that follows joints lie on the triangles of its pose, not on those of the mesh.
TEST(EmissiveLights, ASkinnedLampIsFollowed) {
    const auto lampAt = [](double angle) {
        gltf::Scene scene = skinnedScene(angle);
        scene.lights.clear();
        scene.materials[0] = matte(0.5F);
        materials::Material strip = lamp({1, 1, 1}, 8.0F);
        strip.doubleSided = true;
        scene.materials[1] = strip;
        return scene;
    };
    const gltf::Scene rest = lampAt(0.0);
    const gltf::Scene bent = lampAt(1.2);
    const gltf::Scene still = bakedScene(bent);
    const Ways ways{EmissiveLights::On, 1, 1, false};
    const LoadedScene expected = load(still, ways);
    const LoadedScene moving(rest, settingsOf(ways), [](session::SceneViewData& data) {
        data.lights.clear();
        data.moves = true;
    });
    const MeanEstimate before = estimate(moving, rest, ways, 32);
    session::SceneViewData data = session::makeSceneView(rest);
    session::poseSceneView(bent, data);
    must(moving.gpuScene().updateAndWait(data.motion()));
    const MeanEstimate after = estimate(moving, rest, ways, 32);
    expectSameMean(after, estimate(expected, still, ways, 32), "bent");
    EXPECT_GT(std::abs(after.mean - before.mean), 0.02 * before.mean) << "bending changes nothing";
}

// At as many samples, the noise is a fraction of that of chance, and falls with their root.
TEST(EmissiveLights, TheNoiseIsLess) {
    const gltf::Scene scene = litRoom();
    const Ways chance{EmissiveLights::Off, 0, 2};
    const Ways ways{EmissiveLights::On, 1, 1};
    const LoadedScene byChance = load(scene, chance);
    const LoadedScene sampled = load(scene, ways);
    const LinearImage reference = render(sampled, setupOf(scene, 1024, 1), ways);
    std::array<double, 3> errors{};
    for (int seed = 0; seed < 4; ++seed) {
        errors[0] += squaredDifference(render(byChance, setupOf(scene, 64, 30 + seed), chance), reference);
        errors[1] += squaredDifference(render(sampled, setupOf(scene, 64, 30 + seed), ways), reference);
        errors[2] += squaredDifference(render(sampled, setupOf(scene, 4, 30 + seed), ways), reference);
    }
    std::printf("squared error: by chance %.4g, sampled %.4g, at a sixteenth of the samples %.4g\n",
                errors[0], errors[1], errors[2]);
    EXPECT_LT(errors[1], 0.1 * errors[0]);
    const double slope = 0.5 * std::log2(errors[1] / errors[2]) / 4.0;
    EXPECT_LT(slope, -0.4);
    EXPECT_GT(slope, -0.75);
}

// `--lights auto` takes more samples of more triangles, and does not count a few lights that are apart from
// them.
TEST(EmissiveLights, AutoTakesAFewSamples) {
    const auto samplesOf = [](int quads, int points) {
        gltf::Scene scene = emptyScene();
        const std::int32_t material = addMaterial(scene, lamp({1.0F, 1.0F, 1.0F}, 1.0F));
        for (int i = 0; i < quads; ++i) {
            const auto x = static_cast<float>(i);
            addQuad(scene, material, {x, 0, 0}, {1, 0, 0}, {0, 1, 0});
        }
        gltf::Light light;
        light.type = gltf::LightType::Point;
        scene.lights.assign(static_cast<std::size_t>(points), light);
        compiler::CompileSettings settings = settingsOf({EmissiveLights::On, 1, 1});
        settings.lightSamples.reset();
        return compiler::planLight(gltf::SceneList({&scene, 1}), settings)->samples;
    };
    EXPECT_EQ(samplesOf(4, 0), 2U);
    EXPECT_EQ(samplesOf(4, 16), 2U);
    EXPECT_GT(samplesOf(4, 17), 4U);
    EXPECT_EQ(samplesOf(32, 0), 4U);
    EXPECT_EQ(samplesOf(0, 8), 0U) << "without triangles";
}

// A package without emissive lights has none of their code, and `auto` decides by the bounces.
TEST(EmissiveLights, AutoDecidesByTheBounces) {
    const gltf::Scene scene = litRoom();
    compiler::CompileSettings settings = settingsOf({EmissiveLights::Auto, 1, 1});
    const auto emissive = [&](const gltf::Scene& compiled) {
        const auto plan = compiler::planPackage({&compiled, 1}, settings);
        return plan && std::ranges::any_of(plan->modules, [](const compiler::PlannedModule& module) {
                   return module.text.find("sampleEmitter(") != std::string::npos;
               });
    };
    EXPECT_FALSE(emissive(scene));
    settings.emissiveLights = EmissiveLights::On;
    EXPECT_TRUE(emissive(scene));
    gltf::Scene dark = scene;
    for (materials::Material& material : dark.materials) {
        material["emissiveFactor"] = {0.0F, 0.0F, 0.0F};
    }
    EXPECT_FALSE(emissive(dark));
    settings.emissiveLights = EmissiveLights::Auto;
    settings.maxBounces = 2;
    EXPECT_TRUE(emissive(scene));
    settings.effects.named = compiler::builtinEffects({"indirect-diffuse"});
    EXPECT_FALSE(emissive(scene)) << "without shadow rays";
    settings.emissiveLights = EmissiveLights::On;
    EXPECT_EQ(mustFail(compiler::planPackage({&scene, 1}, settings)).id, "emissive-lights");
}

}  // namespace
