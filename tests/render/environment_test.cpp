// Tests pictures lit by environment maps whose pixels can be computed by hand.
#include "context/context.h"
#include "render/pixel_test.h"
#include "support/must.h"

#include <glint/environment.h>

#include <cmath>
#include <functional>
#include <memory>
#include <numbers>

namespace {

using namespace glint;
using namespace glint::testing;

constexpr float kPi = std::numbers::pi_v<float>;

using Value = std::function<gltf::Float3(gltf::Float3)>;

// Makes a map with `value` at the centre of each texel: u goes from +X towards +Z, with +X in the middle; v
// goes from +Y down.
LinearImage makeMap(std::uint32_t width, std::uint32_t height, const Value& value) {
    LinearImage image{width, height, {}};
    for (std::uint32_t row = 0; row < height; ++row) {
        const float polar = kPi * (static_cast<float>(row) + 0.5F) / static_cast<float>(height);
        for (std::uint32_t column = 0; column < width; ++column) {
            const float azimuth =
                2.0F * kPi * ((static_cast<float>(column) + 0.5F) / static_cast<float>(width) - 0.5F);
            const gltf::Float3 c = value(
                {std::sin(polar) * std::cos(azimuth), std::cos(polar), std::sin(polar) * std::sin(azimuth)});
            image.pixels.push_back({c[0], c[1], c[2], 1.0F});
        }
    }
    return image;
}

std::unique_ptr<Environment> makeEnvironment(std::uint32_t width, std::uint32_t height, const Value& value) {
    return must(Environment::create(sharedContext(), makeMap(width, height, value), {.sampled = true}));
}

constexpr gltf::Float3 kAxisColors[6] = {{1, 0, 0}, {0, 1, 1}, {0, 0, 1}, {1, 1, 0}, {1, 0, 1}, {0, 1, 0}};
constexpr gltf::Float3 kAxes[6] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};

// Returns the colour of the axis that is nearest to the direction: +X red, +Y blue, +Z magenta; opposite axes
// have complementary colours.
gltf::Float3 axisColor(gltf::Float3 d) {
    std::size_t nearest = 0;
    float most = -2.0F;
    for (std::size_t i = 0; i < 6; ++i) {
        const float cosine = d[0] * kAxes[i][0] + d[1] * kAxes[i][1] + d[2] * kAxes[i][2];
        if (cosine > most) {
            most = cosine;
            nearest = i;
        }
    }
    return kAxisColors[nearest];
}

RenderSetup setupWith(const gltf::Scene& scene, const Environment* environment) {
    RenderSetup setup = squareSetup(scene);
    setup.width = setup.height = 33;  // a pixel in the middle, whose ray is the axis
    setup.frame.environment = environment;
    return setup;
}

LoadedScene loadForMap(const gltf::Scene& scene) {
    compiler::CompileSettings settings;
    settings.plan.merge = compiler::MergePolicy::All;
    settings.environmentMap = true;
    settings.energyCompensation = false;
    return LoadedScene(scene, settings);
}

gltf::Scene emptySceneWithCamera() {
    gltf::Scene scene = sceneWithCamera();
    return scene;
}

gltf::Scene wallScene(const materials::Material& material) {
    gltf::Scene scene = emptySceneWithCamera();
    addQuad(scene, material, {-1, -1, -1}, {2, 0, 0}, {0, 2, 0});
    // Only the sky lights the scene.
    addDirectionalLight(scene, {0, 0, 1}, 0.0F);
    return scene;
}

materials::Material roughMetal(float roughness) {
    materials::Material material;
    material["roughnessFactor"] = roughness;
    return material;
}

constexpr package::Strategy kBoth[] = {package::kStrategyUber, package::kStrategyVisibility};

class EnvironmentMap : public ::testing::Test {};

TEST_F(EnvironmentMap, StandsAsItsAxesSay) {
    const gltf::Scene scene = emptySceneWithCamera();
    const LoadedScene loaded = loadForMap(scene);
    const std::unique_ptr<Environment> environment = makeEnvironment(512, 256, axisColor);
    for (std::size_t i = 0; i < 6; ++i) {
        RenderSetup setup = setupWith(scene, environment.get());
        setup.frame.camera.forward = kAxes[i];
        setup.frame.camera.up = i / 2 == 1 ? std::array<float, 3>{0, 0, 1} : std::array<float, 3>{0, 1, 0};
        const LinearImage image = loaded.render(package::kStrategyVisibility, setup);
        expectColor(at(image, 16, 16), kAxisColors[i], 1e-5F, "centre");
    }
    // With +X ahead and +Y up, +Z is on the right.
    RenderSetup setup = setupWith(scene, environment.get());
    setup.frame.camera.forward = {0.8F, 0.0F, 0.6F};
    const LinearImage image = loaded.render(package::kStrategyVisibility, setup);
    expectColor(at(image, 2, 16), {1, 0, 0}, 1e-5F, "left: +X");
    expectColor(at(image, 30, 16), {1, 0, 1}, 1e-5F, "right: +Z");
}

TEST_F(EnvironmentMap, TurnsAboutTheVertical) {
    const gltf::Scene scene = emptySceneWithCamera();
    const LoadedScene loaded = loadForMap(scene);
    const std::unique_ptr<Environment> environment = makeEnvironment(512, 256, axisColor);
    // The camera looks along -Z. Turned counter-clockwise as seen from above, +X moves to -Z, and -Z to -X.
    for (const auto& [turns, axis] : {std::pair{0.25F, 0}, {0.5F, 4}, {-0.25F, 1}, {-7.0F, 5}, {1e4F, 5}}) {
        RenderSetup setup = setupWith(scene, environment.get());
        setup.frame.environmentRotation = 2.0F * kPi * turns;
        setup.frame.environmentIntensity = 3.0F;
        const LinearImage image = loaded.render(package::kStrategyVisibility, setup);
        const gltf::Float3 color = kAxisColors[axis];
        expectColor(at(image, 16, 16), {3 * color[0], 3 * color[1], 3 * color[2]}, 1e-4F, "centre");
    }
}

// At -X, where u jumps from 1 to 0, the map is as smooth as everywhere else.
TEST_F(EnvironmentMap, HasNoSeam) {
    const gltf::Scene scene = emptySceneWithCamera();
    const LoadedScene loaded = loadForMap(scene);
    const auto sky = [](gltf::Float3 d) { return gltf::Float3{1.5F + d[0], 1.5F + d[1], 1.5F + d[2]}; };
    const std::unique_ptr<Environment> environment = makeEnvironment(1024, 512, sky);
    RenderSetup setup = setupWith(scene, environment.get());
    setup.frame.camera.forward = {-1, 0, 0};
    const LinearImage image = loaded.render(package::kStrategyUber, setup);
    for (std::uint32_t y = 0; y < 33; ++y) {
        for (std::uint32_t x = 0; x < 33; ++x) {
            // To the right of -X, with +Y up, is -Z.
            const float right = (static_cast<float>(x) - 16.0F) / 16.5F;
            const float up = (16.0F - static_cast<float>(y)) / 16.5F;
            const float length = std::sqrt(1.0F + right * right + up * up);
            expectColor(at(image, x, y), sky({-1.0F / length, up / length, -right / length}), 1e-4F, "pixel");
        }
    }
}

TEST_F(EnvironmentMap, ShowsInMirrorsOfEveryStrategy) {
    gltf::Scene scene = wallScene(mirrorMaterial());
    const LoadedScene loaded = loadForMap(scene);
    const std::unique_ptr<Environment> environment = makeEnvironment(512, 256, axisColor);
    for (const package::Strategy strategy : kBoth) {
        const LinearImage image = loaded.render(strategy, setupWith(scene, environment.get()));
        expectColor(at(image, 16, 16), {1, 0, 1}, 1e-3F, "centre: +Z");
    }
}

// A sky of one colour gives the same by a map and by a gradient, for every lobe that takes light from it.
TEST_F(EnvironmentMap, OfOneColourEqualsTheGradient) {
    constexpr gltf::Float3 kColor{0.75F, 1.5F, 3.0F};
    materials::Material coated;
    coated["metallicFactor"] = 0.0F;
    coated["roughnessFactor"] = 0.6F;
    coated["baseColorFactor"] = {0.5F, 0.7F, 0.2F, 1.0F};
    coated["clearcoatFactor"] = 0.8F;
    coated["clearcoatRoughnessFactor"] = 0.4F;
    coated.give("KHR_materials_sheen");
    coated["sheenColorFactor"] = {0.3F, 0.3F, 0.5F};
    coated["sheenRoughnessFactor"] = 0.5F;
    const gltf::Scene scene = wallScene(coated);
    const LoadedScene forMap = loadForMap(scene);
    compiler::CompileSettings settings;
    settings.plan.merge = compiler::MergePolicy::All;
    settings.energyCompensation = false;
    const LoadedScene forGradient(scene, settings);
    const std::unique_ptr<Environment> environment =
        makeEnvironment(64, 32, [&](gltf::Float3) { return kColor; });
    RenderSetup gradient = setupWith(scene, nullptr);
    gradient.frame.sky = {kColor, kColor, kColor};
    expectSameImage(forMap.render(package::kStrategyVisibility, setupWith(scene, environment.get())),
                    forGradient.render(package::kStrategyVisibility, gradient), "one colour");
}

// Towards +Z, a sky of 1 + z gives 2 for a mirror, and 1 + 2/3 for a metal of roughness 1, whose lobe is a
// cosine.
TEST_F(EnvironmentMap, RoughSurfacesSeeItsLevels) {
    for (const auto& [roughness, worth] : {std::pair{0.0F, 2.0F}, {1.0F, 5.0F / 3.0F}}) {
        const gltf::Scene scene = wallScene(roughMetal(roughness));
        const LoadedScene loaded = loadForMap(scene);
        const std::unique_ptr<Environment> one = makeEnvironment(512, 256, [](gltf::Float3) {
            return gltf::Float3{1, 1, 1};
        });
        const std::unique_ptr<Environment> slope = makeEnvironment(512, 256, [](gltf::Float3 d) {
            return gltf::Float3{1 + d[2], 1 + d[2], 1 + d[2]};
        });
        RenderSetup setup = setupWith(scene, one.get());
        setup.frame.effects = 0;
        const float even = at(loaded.render(package::kStrategyUber, setup), 16, 16)[0];
        setup.frame.environment = slope.get();
        const float sloped = at(loaded.render(package::kStrategyUber, setup), 16, 16)[0];
        EXPECT_NEAR(sloped / even, worth, 8e-3F) << roughness;
    }
}

// Diffuse light from one side: for a sky of 1 + z it is 1 + 2/3 towards +Z, and 1 + 2/3 cos 60° after
// turning.
TEST_F(EnvironmentMap, DiffuseLightTurnsWithIt) {
    materials::Material material;
    material["metallicFactor"] = 0.0F;
    material["specularFactor"] = 0.0F;
    const gltf::Scene scene = wallScene(material);
    const LoadedScene loaded = loadForMap(scene);
    const std::unique_ptr<Environment> environment = makeEnvironment(512, 256, [](gltf::Float3 d) {
        return gltf::Float3{1 + d[2], 1 + d[0], 1 + d[1]};
    });
    RenderSetup setup = setupWith(scene, environment.get());
    const Pixel before = at(loaded.render(package::kStrategyUber, setup), 16, 16);
    setup.frame.environmentRotation = kPi / 3.0F;
    const Pixel after = at(loaded.render(package::kStrategyUber, setup), 16, 16);
    EXPECT_NEAR(before[0] / before[2], 5.0F / 3.0F, 1e-3F);
    EXPECT_NEAR(before[1] / before[2], 1.0F, 1e-3F);
    EXPECT_NEAR(after[0] / after[2], 4.0F / 3.0F, 1e-3F);
    // +X has turned away from +Z.
    EXPECT_NEAR(after[1] / after[2], 1.0F - 2.0F / 3.0F * std::sin(kPi / 3.0F), 1e-3F);
}

// A device that can't filter 32-bit images gets 16-bit ones. Values above their range are scaled, not lost.
TEST_F(EnvironmentMap, HalfFloatsShowTheSame) {
    const auto sky = [](gltf::Float3 d) {
        return d[2] > 0.9F ? gltf::Float3{4e6F, 2e6F, 1e6F} : gltf::Float3{800, 40, 2};
    };
    const gltf::Scene scene = wallScene(roughMetal(0.0F));
    const LoadedScene loaded = loadForMap(scene);
    const std::unique_ptr<Environment> full = makeEnvironment(256, 128, sky);
    bool& filteredFloats = sharedContext().state().limits.filteredFloats;
    const bool before = filteredFloats;
    filteredFloats = false;
    const std::unique_ptr<Environment> half = makeEnvironment(256, 128, sky);
    filteredFloats = before;
    EXPECT_TRUE(half->statistics().halfFloat);
    const LinearImage a = loaded.render(package::kStrategyVisibility, setupWith(scene, full.get()));
    const LinearImage b = loaded.render(package::kStrategyVisibility, setupWith(scene, half.get()));
    ASSERT_EQ(a.pixels.size(), b.pixels.size());
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        for (std::size_t channel = 0; channel < 3; ++channel) {
            ASSERT_NEAR(b.pixels[i][channel], a.pixels[i][channel], 1e-3F * a.pixels[i][channel]) << i;
        }
    }
    EXPECT_GT(at(a, 16, 16)[0], 3e6F);
}

TEST_F(EnvironmentMap, PackageAndFrameMustAgree) {
    const gltf::Scene scene = emptySceneWithCamera();
    const LoadedScene forMap = loadForMap(scene);
    const LoadedScene forGradient(scene, compiler::CompileSettings{});
    const std::unique_ptr<Environment> environment = makeEnvironment(4, 2, [](gltf::Float3) {
        return gltf::Float3{1, 1, 1};
    });
    const auto errorOf = [](const LoadedScene& loaded, const RenderSetup& setup) {
        const auto renderer = loaded.makeRenderer({package::kStrategyUber, setup.width, setup.height});
        const Result<LinearImage> image = renderer->render(setup.frame);
        return image ? std::string() : image.error().id;
    };
    EXPECT_EQ(errorOf(forMap, setupWith(scene, nullptr)), "environment-missing");
    EXPECT_EQ(errorOf(forGradient, setupWith(scene, environment.get())), "environment-unread");
    RenderSetup dark = setupWith(scene, environment.get());
    dark.frame.environmentIntensity = -1.0F;
    EXPECT_EQ(errorOf(forMap, dark), "frame-options");
}

// A renderer keeps the map of its last frame, and takes another one for the next frame.
TEST_F(EnvironmentMap, ChangesBetweenFrames) {
    const gltf::Scene scene = emptySceneWithCamera();
    const LoadedScene loaded = loadForMap(scene);
    const auto renderer = loaded.makeRenderer({package::kStrategyVisibility, 33, 33});
    for (const gltf::Float3& color : {kRed, kGreen, kBlue}) {
        const std::unique_ptr<Environment> environment =
            makeEnvironment(8, 4, [&](gltf::Float3) { return color; });
        const LinearImage image = must(renderer->render(setupWith(scene, environment.get()).frame));
        expectColor(at(image, 16, 16), color, 1e-5F, "centre");
    }
}

}  // namespace
