// Lights with a size that rays of lobes find: mirrors and glass show them, and on rough surfaces the mean is
// that of light samples alone, with less noise.
#include "base/files.h"
#include "render/harness.h"
#include "render/light_pictures.h"
#include "render/scene_builder.h"
#include "render/ways.h"
#include "support/must.h"
#include "support/nightly.h"
#include "support/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace glint;
using namespace glint::testing;
using compiler::SizedLights;

struct SizedWays {
    SizedLights sized = SizedLights::On;
    std::uint32_t bounces = 1;
    package::ShadowThrough through = package::ShadowThrough::Alpha;
    bool refracts = false;     // with the effect refraction
    std::uint32_t lights = 0;  // --lights
};

compiler::CompileSettings settingsOf(const SizedWays& ways) {
    compiler::CompileSettings settings;
    settings.strategies = package::kStrategyUber;
    settings.plan.merge = compiler::MergePolicy::All;
    settings.effects = {false, compiler::builtinEffects({"shadow", "reflection", "indirect-diffuse"})};
    settings.effects.named |= ways.refracts ? compiler::builtinEffects({"refraction"}) : 0;
    settings.effects.maxReflectionRoughness = 1.0F;
    settings.sizedLights = ways.sized;
    // The black sky is a light in any case, so that rays of diffuse lobes have the weights of the BSDF.
    settings.skyLight = compiler::SkyLight::On;
    settings.emissiveLights = compiler::EmissiveLights::Off;
    settings.shadowThrough = ways.through;
    settings.maxBounces = ways.bounces;
    settings.lightSamples = ways.lights;
    settings.energyCompensation = false;
    return settings;
}

constexpr float kLampRadius = 0.25F;
constexpr float kSunHalfAngle = 0.2F;  // radians

void sizeLights(session::SceneViewData& data) {
    for (LightView& light : data.lights) {
        light.size = light.type == LightView::Type::Directional ? kSunHalfAngle : kLampRadius;
    }
}

// Makes disks of lamps, which shine along a direction.
void makeDisks(session::SceneViewData& data, const std::array<float, 3>& normal) {
    sizeLights(data);
    for (LightView& light : data.lights) {
        if (light.type == LightView::Type::Point) {
            light.type = LightView::Type::Disk;
            light.direction = normal;
        }
    }
}

LoadedScene load(const gltf::Scene& scene, const SizedWays& ways) {
    return LoadedScene(scene, settingsOf(ways), sizeLights);
}

RenderSetup setupOf(const gltf::Scene& scene, std::uint32_t samples, std::uint32_t seed) {
    RenderSetup setup = defaultSetup(scene, 16, 16);
    setup.frame.sky = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
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

void addLamp(gltf::Scene& scene, gltf::Float3 position, float candela) {
    gltf::Light lamp;
    lamp.type = gltf::LightType::Point;
    lamp.intensity = candela;
    lamp.position = {position[0], position[1], position[2]};
    scene.lights.push_back(lamp);
}

materials::Material metalOf(float roughness) {
    materials::Material metal = mirrorMaterial();
    metal["roughnessFactor"] = roughness;
    return metal;
}

// A diffuse lobe below a rough glossy one.
materials::Material plastic(float albedo) {
    materials::Material material = matte(albedo);
    material["specularFactor"] = 1.0F;
    return material;
}

// The mean of the picture in which a disk of an angle about the camera's axis has a radiance: 90° by 90°.
double meanOfDisk(double radiance, double tangent) {
    return radiance * std::numbers::pi * tangent * tangent / 4.0;
}

// A lamp as a sphere at a distance.
double meanOfSphere(double candela, double distance) {
    const double area = std::numbers::pi * kLampRadius * kLampRadius;
    return meanOfDisk(candela / area, std::tan(std::asin(kLampRadius / distance)));
}

// A mirror before the camera, and one behind it.
gltf::Scene mirrors() {
    gltf::Scene scene = sceneWithCamera();
    addQuad(scene, mirrorMaterial(), {-50, -50, -2}, {100, 0, 0}, {0, 100, 0});
    addQuad(scene, mirrorMaterial(), {50, -50, 1}, {-100, 0, 0}, {0, 100, 0});
    return scene;
}

// Two lamps between mirrors, which the camera does not see by themselves, are 3.5 and 4.5, 6.5 and 5.5, 9.5
// and 10.5 m away. Paths look for them once more than they have bounces. Nothing of them is seen without the
// setting.
TEST(FoundLights, MirrorsShowLamps) {
    gltf::Scene scene = mirrors();
    addLamp(scene, {0, 0, -0.5F}, 2.0F);
    addLamp(scene, {0, 0, 0.5F}, 1.0F);
    for (const auto& [bounces, lights] : {std::pair(1U, 0U), std::pair(2U, 0U), std::pair(2U, 1U)}) {
        const LoadedScene loaded =
            load(scene, {SizedLights::On, bounces, package::ShadowThrough::Alpha, false, lights});
        EXPECT_TRUE(loaded.package().sizedLights());
        const LinearImage image = render(loaded, setupOf(scene, 256, 1), bounces);
        // Packages for one bounce do not look for lights at hits.
        double expected = meanOfSphere(2.0, 3.5) + meanOfSphere(1.0, 4.5);
        if (bounces > 1) {
            expected += meanOfSphere(2.0, 6.5) + meanOfSphere(2.0, 9.5) + meanOfSphere(1.0, 5.5) +
                        meanOfSphere(1.0, 10.5);
        }
        std::printf("%u bounces, %u lights: %.5f, expected %.5f\n", bounces, lights, meanOf(image, 0),
                    expected);
        EXPECT_NEAR(meanOf(image, 0), expected, 0.015 * expected);
    }
    const LoadedScene unseen = load(scene, {SizedLights::Off});
    EXPECT_FALSE(unseen.package().sizedLights());
    EXPECT_LT(meanOf(render(unseen, setupOf(scene, 16, 1), 1), 0), 0.1 * meanOfSphere(2.0, 3.5));
}

// A disk between mirrors is seen from its front alone: at first from 3.5 m, or only by paths, from 6.5
// and 9.5.
TEST(FoundLights, MirrorsShowTheFrontsOfDisks) {
    gltf::Scene scene = mirrors();
    addLamp(scene, {0, 0, -0.5F}, 2.0F);
    const double area = std::numbers::pi * kLampRadius * kLampRadius;
    const auto seen = [&](double distance) { return meanOfDisk(2.0 / area, kLampRadius / distance); };
    for (const float front : {-1.0F, 1.0F}) {
        for (const std::uint32_t lights : {0U, 1U}) {
            const LoadedScene loaded(
                scene, settingsOf({SizedLights::On, 2, package::ShadowThrough::Alpha, false, lights}),
                [&](session::SceneViewData& data) {
                    makeDisks(data, {0, 0, front});
                });
            const double expected = front < 0.0F ? seen(3.5) + seen(9.5) : seen(6.5);
            EXPECT_NEAR(meanOf(render(loaded, setupOf(scene, 64, 1), 2), 0), expected, 0.08 * expected)
                << front << ", " << lights << " lights";
        }
    }
}

// A mirror takes no samples, so what it shows depends on the search for lights alone. All of a few hundred
// lights are looked at without a hierarchy.
TEST(FoundLights, AMirrorShowsTheSameWithAHierarchy) {
    gltf::Scene scene = sceneWithCamera();
    addQuad(scene, mirrorMaterial(), {-50, -50, -2}, {100, 0, 0}, {0, 100, 0});
    std::mt19937 random(7);
    std::uniform_real_distribution<float> unit(0.0F, 1.0F);
    for (int i = 0; i < 300; ++i) {
        addLamp(scene, {8.0F * unit(random) - 4.0F, 8.0F * unit(random) - 4.0F, 6.0F * unit(random) - 1.5F},
                1.0F);
        scene.lights.back().range = i % 3 == 0 ? 4.0F : 0.0F;
    }
    addDirectionalLight(scene, {0, 0, -1}, 3.0F);
    const auto sizes = [](session::SceneViewData& data) {
        for (std::size_t i = 0; i < data.lights.size(); ++i) {
            data.lights[i].size = 0.01F * static_cast<float>(1 + i % 40);
        }
    };
    std::vector<LinearImage> images;
    for (const std::uint32_t lights : {0U, 4U}) {
        const LoadedScene loaded(
            scene, settingsOf({SizedLights::On, 1, package::ShadowThrough::Alpha, false, lights}), sizes);
        images.push_back(render(loaded, setupOf(scene, 16, 1), 1));
        ASSERT_FALSE(images.back().pixels.empty());
    }
    EXPECT_GT(meanOf(images[0]), 0.1);
    expectSameImage(images[1], images[0], "with a hierarchy");
}

TEST(FoundLights, AMirrorShowsTheSunUnlessItIsHidden) {
    gltf::Scene scene = sceneWithCamera();
    addQuad(scene, mirrorMaterial(), {-50, -50, -2}, {100, 0, 0}, {0, 100, 0});
    addDirectionalLight(scene, {0, 0, -1}, 3.0F);
    const double sine = std::sin(kSunHalfAngle);
    const double whole = meanOfDisk(3.0 / (std::numbers::pi * sine * sine), std::tan(kSunHalfAngle));
    const LoadedScene open = load(scene, {});
    EXPECT_NEAR(meanOf(render(open, setupOf(scene, 256, 1), 1), 0), whole, 0.01 * whole);
    // A black wall behind the camera hides the sun's right half.
    addQuad(scene, matte(0.0F), {50, -50, 3}, {-50, 0, 0}, {0, 100, 0});
    const LoadedScene hidden = load(scene, {});
    EXPECT_NEAR(meanOf(render(hidden, setupOf(scene, 256, 1), 1), 0), 0.5 * whole, 0.02 * whole);
}

// Thin glass whose index is that of air passes its tint.
TEST(FoundLights, GlassShowsALamp) {
    gltf::Scene scene = sceneWithCamera();
    materials::Material glass = plastic(1.0F);
    glass["baseColorFactor"] = {0.25F, 0.5F, 0.75F, 1.0F};
    glass["roughnessFactor"] = 0.0F;
    glass["transmissionFactor"] = 1.0F;
    glass["ior"] = 1.0F;
    glass.doubleSided = true;
    addQuad(scene, glass, {-50, -50, -1}, {100, 0, 0}, {0, 100, 0});
    addLamp(scene, {0, 0, -3}, 2.0F);
    const LoadedScene loaded = load(scene, {SizedLights::On, 1, package::ShadowThrough::Alpha, true});
    const LinearImage image = render(loaded, setupOf(scene, 256, 1), 1);
    for (std::size_t channel = 0; channel < 3; ++channel) {
        const double expected = 0.25 * static_cast<double>(channel + 1) * meanOfSphere(2.0, 3.0);
        EXPECT_NEAR(meanOf(image, channel), expected, 0.01 * expected);
    }
}

// A room with surfaces of several lobes, lit by lamps and through an opening by a sun. `glazed` puts glass
// in the opening, and another pane before the wall.
gltf::Scene room(bool glazed) {
    gltf::Scene scene = sceneWithCamera();
    materials::Material glossy = plastic(0.5F);
    glossy["roughnessFactor"] = 0.4F;
    materials::Material coated = plastic(0.3F);
    coated["clearcoatFactor"] = 1.0F;
    coated["clearcoatRoughnessFactor"] = 0.4F;
    materials::Material sheet = plastic(0.3F);
    sheet["diffuseTransmissionFactor"] = 0.5F;
    sheet.doubleSided = true;
    addQuad(scene, glossy, {-2, -1, 1}, {4, 0, 0}, {0, 0, -5});
    addQuad(scene, metalOf(0.45F), {-2, -1, -4}, {4, 0, 0}, {0, 2.5F, 0});
    addQuad(scene, coated, {-2, -1, 1}, {0, 0, -5}, {0, 2.5F, 0});
    addQuad(scene, plastic(0.5F), {2, -1, -4}, {0, 0, 5}, {0, 2.5F, 0});
    addQuad(scene, plastic(0.6F), {-2, 1.5F, -4}, {2, 0, 0}, {0, 0, 5});
    addQuad(scene, sheet, {0.5F, -0.8F, -2.0F}, {0.8F, 0, -0.8F}, {0, 1.0F, 0});
    if (glazed) {
        materials::Material glass = plastic(0.0F);
        glass["roughnessFactor"] = 0.3F;
        glass["transmissionFactor"] = 1.0F;
        glass["baseColorFactor"] = {0.6F, 0.8F, 0.7F, 1.0F};
        glass.doubleSided = true;
        addQuad(scene, glass, {0, 1.5F, -4}, {2, 0, 0}, {0, 0, 5});
        addQuad(scene, glass, {-1.5F, -0.8F, -3.0F}, {1.2F, 0, 0.3F}, {0, 1.2F, 0});
    }
    addLamp(scene, {-0.6F, 0.4F, -3.2F}, 1.0F);
    addLamp(scene, {1.2F, 0.6F, -2.2F}, 0.3F);
    addLamp(scene, {-1.2F, -0.2F, -1.2F}, 0.2F);
    addDirectionalLight(scene, {-0.1961161F, -0.9805807F, 0}, 3.0F);
    return scene;
}

void addShiningQuad(gltf::Scene& scene) {
    materials::Material shining = matte(0.0F);
    shining["emissiveFactor"] = {1.0F, 0.6F, 0.3F};
    addQuad(scene, shining, {-1.99F, -0.5F, -1.0F}, {0, 0, -1.5F}, {0, 1.0F, 0});
}

MeanEstimate estimate(const LoadedScene& loaded, const gltf::Scene& scene, std::uint32_t bounces,
                      std::uint32_t samples) {
    return estimateMean(40, [&](std::uint32_t seed) {
        RenderSetup setup = setupOf(scene, samples, seed);
        setup.frame.shadowSamples = 2;
        return render(loaded, setup, bounces);
    });
}

// No light counts twice, and none is lost: on primary surfaces, at hits of one bounce and of paths, where
// shadow rays pass glass, and with a hierarchy. By day two of them are looked at.
TEST(FoundLights, TheMeanIsThatOfLightSamples) {
    struct Case {
        std::uint32_t bounces;
        package::ShadowThrough through;
        std::vector<std::uint32_t> lights;
    };
    std::vector<Case> cases{{1, package::ShadowThrough::Alpha, {1}}, {3, package::ShadowThrough::Glass, {2}}};
    if (test::nightly()) {
        cases.push_back({3, package::ShadowThrough::Alpha, {}});
    }
    for (Case& one : cases) {
        one.lights = test::nightly() ? std::vector{0U, 1U, 2U} : one.lights;
        const gltf::Scene scene = room(one.bounces > 1);
        const std::uint32_t samples = test::nightly() ? 192 : 64;
        const LoadedScene sampled = load(scene, {SizedLights::Off, one.bounces, one.through});
        const MeanEstimate expected = estimate(sampled, scene, one.bounces, samples);
        for (const std::uint32_t lights : one.lights) {
            const LoadedScene found = load(scene, {SizedLights::On, one.bounces, one.through, false, lights});
            const MeanEstimate mean = estimate(found, scene, one.bounces, samples);
            EXPECT_LT(mean.error, 0.01 * mean.mean);
            expectSameMean(mean, expected,
                           fmt::format("{} bounces, shadow rays through {}, {} lights", one.bounces,
                                       static_cast<unsigned>(one.through), lights));
        }
    }
}

// Packages with emissive lights know disks without looking for them.
TEST(FoundLights, TheMeanOfDisksIsThatOfTheirSamples) {
    gltf::Scene scene = room(false);
    addShiningQuad(scene);
    std::array<MeanEstimate, 2> means{};
    for (const SizedLights sized : {SizedLights::Off, SizedLights::On}) {
        compiler::CompileSettings settings = settingsOf({sized, 2, package::ShadowThrough::Alpha, false, 2});
        settings.emissiveLights = compiler::EmissiveLights::On;
        const LoadedScene loaded(scene, settings, [](session::SceneViewData& data) {
            makeDisks(data, {0.6F, -0.8F, 0});
        });
        means[sized == SizedLights::On ? 1 : 0] = estimate(loaded, scene, 2, 32);
    }
    expectSameMean(means[1], means[0], "disks");
}

// More than a few lights are in the hierarchy of emissive triangles.
TEST(FoundLights, ShareAHierarchyWithTriangles) {
    gltf::Scene scene = room(false);
    addShiningQuad(scene);
    for (int i = 0; i < 16; ++i) {
        addLamp(scene, {-1.5F + 0.4F * static_cast<float>(i % 8), i < 8 ? 1.1F : -0.6F, -2.5F}, 0.1F);
    }
    std::array<MeanEstimate, 2> means{};
    for (const SizedLights sized : {SizedLights::Off, SizedLights::On}) {
        compiler::CompileSettings settings = settingsOf({sized, 1, package::ShadowThrough::Alpha, false, 2});
        settings.emissiveLights = compiler::EmissiveLights::On;
        const LoadedScene loaded(scene, settings, sizeLights);
        means[sized == SizedLights::On ? 1 : 0] = estimate(loaded, scene, 1, 64);
    }
    expectSameMean(means[1], means[0], "with triangles");
}

// At a roughness of 0.05 light samples hardly fall into the lobe. At 0.4 rays hardly find the lamp: the
// balance heuristic costs little there.
TEST(FoundLights, TheNoiseOfHighlightsIsLess) {
    for (const float roughness : {0.05F, 0.4F}) {
        gltf::Scene scene = sceneWithCamera();
        addQuad(scene, metalOf(roughness), {-50, -50, -2}, {100, 0, 0}, {0, 100, 0});
        addLamp(scene, {0, 0, -0.5F}, 2.0F);
        const LoadedScene found = load(scene, {SizedLights::On});
        const LoadedScene sampled = load(scene, {SizedLights::Off});
        const LinearImage reference = render(found, setupOf(scene, 2048, 1), 1);
        std::array<double, 2> errors{};
        for (int seed = 0; seed < 3; ++seed) {
            errors[0] += squaredDifference(render(sampled, setupOf(scene, 32, 30 + seed), 1), reference);
            errors[1] += squaredDifference(render(found, setupOf(scene, 32, 30 + seed), 1), reference);
        }
        std::printf("roughness %.2f, squared error: light samples %.4g, with rays %.4g\n",
                    static_cast<double>(roughness), errors[0], errors[1]);
        EXPECT_LT(errors[1], (roughness < 0.1F ? 0.1 : 2.5) * errors[0]);
    }
}

TEST(FoundLights, StrategiesAgree) {
    gltf::Scene scene = room(true);
    addShiningQuad(scene);
    for (const bool others : {false, true}) {
        if (!others && !test::nightly()) {
            continue;
        }
        compiler::CompileSettings settings =
            settingsOf({SizedLights::On, 3,
                        others ? package::ShadowThrough::Glass : package::ShadowThrough::Alpha, true});
        settings.shadows = others ? package::ShadowPlacement::Inline : package::ShadowPlacement::Deferred;
        // Beside emissive triangles the hierarchy leaves a few lights apart.
        settings.emissiveLights = others ? compiler::EmissiveLights::On : compiler::EmissiveLights::Off;
        settings.skyLight = others ? compiler::SkyLight::On : compiler::SkyLight::Off;
        settings.lightSamples = others ? 1U : 2U;
        std::optional<LinearImage> reference;
        forEachWay(
            scene, settings,
            [&](const LoadedScene& loaded, const Way& way) {
                RendererOptions options = optionsOf(way);
                options.bounces = 3;
                RenderSetup setup = setupOf(scene, 4, 1);
                setup.frame.shadowSamples = 2;
                const LinearImage image = loaded.render(options, setup);
                reference = reference.value_or(image);
                expectSameImage(image, *reference, nameOf(way));
            },
            sizeLights);
    }
}

// A package without the setting has none of its code. `auto` decides by bounces, effects and whether the
// renderer gives lights a size.
TEST(FoundLights, AutoDecidesByBouncesEffectsAndSizes) {
    const gltf::Scene scene = room(false);
    compiler::CompileSettings settings = settingsOf({SizedLights::Auto, 2});
    const auto finds = [&] {
        const auto plan = compiler::planPackage({&scene, 1}, settings);
        return plan && std::ranges::any_of(plan->modules, [](const compiler::PlannedModule& module) {
                   return module.text.find("lobesFind(") != std::string::npos;
               });
    };
    EXPECT_FALSE(finds()) << "without a size";
    settings.sizesLights = true;
    EXPECT_TRUE(finds());
    settings.maxBounces = 1;
    EXPECT_FALSE(finds()) << "of one bounce";
    settings.sizedLights = SizedLights::On;
    EXPECT_TRUE(finds());
    settings.sizedLights = SizedLights::Auto;
    settings.maxBounces = 2;
    settings.skyLight = compiler::SkyLight::Auto;
    settings.effects.named = compiler::builtinEffects({"reflection"});
    EXPECT_FALSE(finds()) << "without shadow rays";
    settings.sizedLights = SizedLights::On;
    EXPECT_EQ(mustFail(compiler::planPackage({&scene, 1}, settings)).id, "sized-lights");
}

// A host's own lights are not Glint's to find.
TEST(FoundLights, AHostsOwnLightsAreNotFound) {
    const gltf::Scene scene = room(false);
    compiler::CompileSettings settings = settingsOf({SizedLights::On, 2});
    settings.skyLight = compiler::SkyLight::Off;
    const test::TemporaryFolder folder;
    ASSERT_TRUE(base::writeFile(folder.path() / "lights.glsl", "// lights of a host\n"));
    settings.host = folder.path().string();
    EXPECT_EQ(mustFail(compiler::planPackage({&scene, 1}, settings)).id, "sized-lights");
}

}  // namespace
