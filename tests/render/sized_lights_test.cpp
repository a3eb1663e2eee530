// Lights with a size that rays of lobes find: mirrors and glass show them, and on rough surfaces the mean is
// that of light samples alone, with less noise.
#include "base/files.h"
#include "render/harness.h"
#include "render/scene_builder.h"
#include "render/ways.h"
#include "support/nightly.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <numbers>
#include <optional>
#include <string>

namespace {

using namespace glint;
using namespace glint::testing;
using compiler::SizedLights;

struct SizedWays {
    SizedLights sized = SizedLights::On;
    std::uint32_t bounces = 1;
    package::ShadowThrough through = package::ShadowThrough::Alpha;
    bool refracts = false;  // with the effect refraction
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
    settings.energyCompensation = false;
    return settings;
}

constexpr float kLampRadius = 0.25F;
constexpr float kSunHalfAngle = 0.2F;  // radians

void sizeLights(scene_view::SceneViewData& data) {
    for (LightView& light : data.lights) {
        light.size = light.type == LightView::Type::Directional ? kSunHalfAngle : kLampRadius;
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

double meanOf(const LinearImage& image, std::size_t channel) {
    double sum = 0.0;
    for (const auto& pixel : image.pixels) {
        sum += pixel[channel];
    }
    return sum / static_cast<double>(image.pixels.size());
}

void addLamp(gltf::Scene& scene, gltf::Float3 position, float candela) {
    gltf::Light lamp;
    lamp.type = gltf::LightType::Point;
    lamp.intensity = candela;
    lamp.position = position;
    scene.lights.push_back(lamp);
}

void addQuad(gltf::Scene& scene, const materials::Material& material, gltf::Float3 corner, gltf::Float3 right,
             gltf::Float3 up) {
    addInstance(scene, addMesh(scene, makeQuad(addMaterial(scene, material), corner, right, up)));
}

materials::Material metalOf(float roughness) {
    materials::Material metal = mirrorMaterial();
    metal["roughnessFactor"] = roughness;
    return metal;
}

materials::Material matte(float albedo) {
    materials::Material material;
    material["baseColorFactor"] = {albedo, albedo, albedo, 1.0F};
    material["metallicFactor"] = 0.0F;
    material["roughnessFactor"] = 1.0F;
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
    gltf::Scene scene = emptyScene();
    addCamera(scene);
    addQuad(scene, mirrorMaterial(), {-50, -50, -2}, {100, 0, 0}, {0, 100, 0});
    addQuad(scene, mirrorMaterial(), {50, -50, 1}, {-100, 0, 0}, {0, 100, 0});
    return scene;
}

// A lamp between mirrors, which the camera does not see by itself, is 3.5, 6.5 and 9.5 m away. Paths look for
// it once more than they have bounces. Nothing of it is seen without the setting.
TEST(FoundLights, MirrorsShowALamp) {
    gltf::Scene scene = mirrors();
    addLamp(scene, {0, 0, -0.5F}, 2.0F);
    for (const std::uint32_t bounces : {1U, 2U}) {
        const LoadedScene loaded = load(scene, {SizedLights::On, bounces});
        ASSERT_TRUE(loaded.ok());
        EXPECT_TRUE(loaded.package().sizedLights());
        const LinearImage image = render(loaded, setupOf(scene, 256, 1), bounces);
        // Packages for one bounce do not look for lights at hits.
        const double expected =
            meanOfSphere(2.0, 3.5) + (bounces > 1 ? meanOfSphere(2.0, 6.5) + meanOfSphere(2.0, 9.5) : 0.0);
        std::printf("%u bounces: %.5f, expected %.5f\n", bounces, meanOf(image, 0), expected);
        EXPECT_NEAR(meanOf(image, 0), expected, 0.015 * expected);
    }
    const LoadedScene unseen = load(scene, {SizedLights::Off});
    ASSERT_TRUE(unseen.ok());
    EXPECT_FALSE(unseen.package().sizedLights());
    EXPECT_LT(meanOf(render(unseen, setupOf(scene, 16, 1), 1), 0), 0.1 * meanOfSphere(2.0, 3.5));
}

TEST(FoundLights, AMirrorShowsTheSunUnlessItIsHidden) {
    gltf::Scene scene = emptyScene();
    addCamera(scene);
    addQuad(scene, mirrorMaterial(), {-50, -50, -2}, {100, 0, 0}, {0, 100, 0});
    addDirectionalLight(scene, {0, 0, -1}, 3.0F);
    const double sine = std::sin(kSunHalfAngle);
    const double whole = meanOfDisk(3.0 / (std::numbers::pi * sine * sine), std::tan(kSunHalfAngle));
    const LoadedScene open = load(scene, {});
    ASSERT_TRUE(open.ok());
    EXPECT_NEAR(meanOf(render(open, setupOf(scene, 256, 1), 1), 0), whole, 0.01 * whole);
    // A black wall behind the camera hides the sun's right half.
    materials::Material black = matte(0.0F);
    black["specularFactor"] = 0.0F;
    addQuad(scene, black, {50, -50, 3}, {-50, 0, 0}, {0, 100, 0});
    const LoadedScene hidden = load(scene, {});
    ASSERT_TRUE(hidden.ok());
    EXPECT_NEAR(meanOf(render(hidden, setupOf(scene, 256, 1), 1), 0), 0.5 * whole, 0.02 * whole);
}

// Thin glass whose index is that of air passes its tint.
TEST(FoundLights, GlassShowsALamp) {
    gltf::Scene scene = emptyScene();
    addCamera(scene);
    materials::Material glass = matte(1.0F);
    glass["baseColorFactor"] = {0.25F, 0.5F, 0.75F, 1.0F};
    glass["roughnessFactor"] = 0.0F;
    glass["transmissionFactor"] = 1.0F;
    glass["ior"] = 1.0F;
    glass.doubleSided = true;
    addQuad(scene, glass, {-50, -50, -1}, {100, 0, 0}, {0, 100, 0});
    addLamp(scene, {0, 0, -3}, 2.0F);
    const LoadedScene loaded = load(scene, {SizedLights::On, 1, package::ShadowThrough::Alpha, true});
    ASSERT_TRUE(loaded.ok());
    const LinearImage image = render(loaded, setupOf(scene, 256, 1), 1);
    for (std::size_t channel = 0; channel < 3; ++channel) {
        const double expected = 0.25 * static_cast<double>(channel + 1) * meanOfSphere(2.0, 3.0);
        EXPECT_NEAR(meanOf(image, channel), expected, 0.01 * expected);
    }
}

// A room with surfaces of several lobes, lit by a lamp and through an opening by a sun. `glazed` puts glass
// in the opening, and another pane before the wall.
gltf::Scene room(bool glazed) {
    gltf::Scene scene = emptyScene();
    addCamera(scene);
    materials::Material glossy = matte(0.5F);
    glossy["roughnessFactor"] = 0.4F;
    materials::Material coated = matte(0.3F);
    coated["clearcoatFactor"] = 1.0F;
    coated["clearcoatRoughnessFactor"] = 0.4F;
    materials::Material sheet = matte(0.3F);
    sheet["diffuseTransmissionFactor"] = 0.5F;
    sheet.doubleSided = true;
    addQuad(scene, glossy, {-2, -1, 1}, {4, 0, 0}, {0, 0, -5});
    addQuad(scene, metalOf(0.45F), {-2, -1, -4}, {4, 0, 0}, {0, 2.5F, 0});
    addQuad(scene, coated, {-2, -1, 1}, {0, 0, -5}, {0, 2.5F, 0});
    addQuad(scene, matte(0.5F), {2, -1, -4}, {0, 0, 5}, {0, 2.5F, 0});
    addQuad(scene, matte(0.6F), {-2, 1.5F, -4}, {2, 0, 0}, {0, 0, 5});
    addQuad(scene, sheet, {0.5F, -0.8F, -2.0F}, {0.8F, 0, -0.8F}, {0, 1.0F, 0});
    if (glazed) {
        materials::Material glass = matte(0.0F);
        glass["roughnessFactor"] = 0.3F;
        glass["transmissionFactor"] = 1.0F;
        glass["baseColorFactor"] = {0.6F, 0.8F, 0.7F, 1.0F};
        glass.doubleSided = true;
        addQuad(scene, glass, {0, 1.5F, -4}, {2, 0, 0}, {0, 0, 5});
        addQuad(scene, glass, {-1.5F, -0.8F, -3.0F}, {1.2F, 0, 0.3F}, {0, 1.2F, 0});
    }
    addLamp(scene, {-0.6F, 0.4F, -3.2F}, 1.0F);
    addDirectionalLight(scene, {-0.1961161F, -0.9805807F, 0}, 3.0F);
    return scene;
}

struct MeanOfPictures {
    double mean = 0.0;
    double error = 0.0;  // standard error
};

MeanOfPictures estimate(const LoadedScene& loaded, const gltf::Scene& scene, std::uint32_t bounces,
                        std::uint32_t samples) {
    constexpr int kPictures = 6;
    double sum = 0.0;
    double squares = 0.0;
    for (int seed = 0; seed < kPictures; ++seed) {
        RenderSetup setup = setupOf(scene, samples, 40 + seed);
        setup.frame.shadowSamples = 2;
        const LinearImage image = render(loaded, setup, bounces);
        const double mean = meanOf(image, 0) + meanOf(image, 1) + meanOf(image, 2);
        sum += mean;
        squares += mean * mean;
    }
    const double mean = sum / kPictures;
    return {mean, std::sqrt(std::max(squares / kPictures - mean * mean, 0.0) / (kPictures - 1))};
}

// No light counts twice, and none is lost: on primary surfaces, at hits of one bounce and of paths, and where
// shadow rays pass glass.
TEST(FoundLights, TheMeanIsThatOfLightSamples) {
    struct Case {
        std::uint32_t bounces;
        package::ShadowThrough through;
    };
    for (const Case& one : {Case{1, package::ShadowThrough::Alpha}, Case{3, package::ShadowThrough::Alpha},
                            Case{3, package::ShadowThrough::Glass}}) {
        const bool glazed = one.bounces > 1;
        const gltf::Scene scene = room(glazed);
        const LoadedScene found = load(scene, {SizedLights::On, one.bounces, one.through});
        const LoadedScene sampled = load(scene, {SizedLights::Off, one.bounces, one.through});
        ASSERT_TRUE(found.ok() && sampled.ok());
        const std::uint32_t samples = test::nightly() ? 192 : 64;
        const MeanOfPictures a = estimate(found, scene, one.bounces, samples);
        const MeanOfPictures b = estimate(sampled, scene, one.bounces, samples);
        std::printf("%u bounces, shadow rays through %u: %.5f ± %.5f, sampled %.5f ± %.5f\n", one.bounces,
                    static_cast<unsigned>(one.through), a.mean, a.error, b.mean, b.error);
        EXPECT_GT(b.mean, 0.1);
        EXPECT_LT(a.error, 0.01 * a.mean);
        EXPECT_NEAR(a.mean, b.mean, 4.0 * std::hypot(a.error, b.error) + 1e-3 * b.mean);
    }
}

double squaredDifference(const LinearImage& image, const LinearImage& reference) {
    double sum = 0.0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        for (std::size_t channel = 0; channel < 3; ++channel) {
            const double difference = image.pixels[i][channel] - reference.pixels[i][channel];
            sum += difference * difference;
        }
    }
    return sum;
}

// At a roughness of 0.05 light samples hardly fall into the lobe. At 0.4 rays hardly find the lamp: the
// balance heuristic costs little there.
TEST(FoundLights, TheNoiseOfHighlightsIsLess) {
    for (const float roughness : {0.05F, 0.4F}) {
        gltf::Scene scene = emptyScene();
        addCamera(scene);
        addQuad(scene, metalOf(roughness), {-50, -50, -2}, {100, 0, 0}, {0, 100, 0});
        addLamp(scene, {0, 0, -0.5F}, 2.0F);
        const LoadedScene found = load(scene, {SizedLights::On});
        const LoadedScene sampled = load(scene, {SizedLights::Off});
        ASSERT_TRUE(found.ok() && sampled.ok());
        const LinearImage reference = render(found, setupOf(scene, 2048, 1), 1);
        ASSERT_FALSE(reference.pixels.empty());
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
    materials::Material shining = matte(0.0F);
    shining["emissiveFactor"] = {1.0F, 0.6F, 0.3F};
    addQuad(scene, shining, {-1.99F, -0.5F, -1.0F}, {0, 0, -1.5F}, {0, 1.0F, 0});
    for (const bool others : {false, true}) {
        compiler::CompileSettings settings =
            settingsOf({SizedLights::On, 3,
                        others ? package::ShadowThrough::Glass : package::ShadowThrough::Alpha, true});
        settings.shadows = others ? package::ShadowPlacement::Inline : package::ShadowPlacement::Deferred;
        // Beside emissive triangles the hierarchy leaves a few lights apart.
        settings.emissiveLights = others ? compiler::EmissiveLights::On : compiler::EmissiveLights::Off;
        settings.skyLight = others ? compiler::SkyLight::On : compiler::SkyLight::Off;
        settings.lightSamples = others ? 1U : 0U;
        std::optional<LinearImage> reference;
        forEachWay(
            scene, settings,
            [&](const LoadedScene& loaded, const Way& way) {
                RendererOptions options = optionsOf(way);
                options.bounces = 3;
                RenderSetup setup = setupOf(scene, 4, 1);
                setup.frame.shadowSamples = 2;
                const LinearImage image = loaded.render(options, setup);
                ASSERT_FALSE(image.pixels.empty());
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
                   return module.text.find("#define GLINT_SIZED_LIGHTS 1") != std::string::npos;
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
    const auto refused = compiler::planPackage({&scene, 1}, settings);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().id, "sized-lights");
}

// A host's own lights, and the steps of its own rays, are not Glint's to find.
TEST(FoundLights, AHostsOwnLightsAreNotFound) {
    const gltf::Scene scene = room(false);
    compiler::CompileSettings settings = settingsOf({SizedLights::On, 2});
    settings.skyLight = compiler::SkyLight::Off;
    settings.passes = package::Passes::Steps;
    const auto steps = compiler::planPackage({&scene, 1}, settings);
    ASSERT_FALSE(steps);
    EXPECT_EQ(steps.error().id, "sized-lights");
    settings.passes = package::Passes::Frame;
    const test::TemporaryFolder folder;
    ASSERT_TRUE(base::writeFile(folder.path() / "lights.glsl", "// lights of a host\n"));
    settings.host = folder.path().string();
    const auto host = compiler::planPackage({&scene, 1}, settings);
    ASSERT_FALSE(host);
    EXPECT_EQ(host.error().id, "sized-lights");
}

}  // namespace
