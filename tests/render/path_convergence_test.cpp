// Paths converge at their rate with every kind of light, and to the same mean whatever strategy shades them
// and however many lights a surface takes.
#include "render/harness.h"
#include "render/light_pictures.h"
#include "render/scene_builder.h"
#include "support/must.h"
#include "support/nightly.h"

#include <glint/environment.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace {

using namespace glint;
using namespace glint::testing;

constexpr std::uint32_t kBounces = 4;

materials::Material coated(float albedo, float roughness, float metallic) {
    materials::Material material;
    material["baseColorFactor"] = {albedo, 0.8F * albedo, 0.6F * albedo, 1.0F};
    material["metallicFactor"] = metallic;
    material["roughnessFactor"] = roughness;
    return material;
}

// A floor between a matte wall and a glossy one, below the sky, and a block that throws a shadow.
gltf::Scene yard() {
    gltf::Scene scene = sceneWithCamera();
    addQuad(scene, coated(0.7F, 0.8F, 0.0F), {-3, -1, 1}, {6, 0, 0}, {0, 0, -5});
    addQuad(scene, coated(0.8F, 0.45F, 1.0F), {-3, -1, -4}, {6, 0, 0}, {0, 2.5F, 0});
    addQuad(scene, coated(0.6F, 1.0F, 0.0F), {-2, -1, -1}, {0, 0, -3}, {0, 2, 0});
    addQuad(scene, coated(0.5F, 0.7F, 0.0F), {0.3F, -1, -2.5F}, {0.8F, 0, 0.3F}, {0, 0.9F, 0});
    return scene;
}

void addLamps(gltf::Scene& scene) {
    gltf::Light point;
    point.type = gltf::LightType::Point;
    point.position = {1.2F, 1.4F, -1.8F};
    point.intensity = 4.0F;
    point.color = {1.0F, 0.9F, 0.7F};
    scene.lights.push_back(point);
    gltf::Light spot = point;
    spot.type = gltf::LightType::Spot;
    spot.position = {-1.0F, 2.0F, -1.0F};
    spot.direction = {0.0F, -1.0F, 0.0F};
    spot.intensity = 8.0F;
    spot.innerConeAngle = 0.3F;
    spot.outerConeAngle = 0.9F;
    scene.lights.push_back(spot);
    addDirectionalLight(scene, {0.3F, -0.9F, -0.3F}, 0.7F);
}

// A lamp above the view, and another one beside it: their edges in the picture would converge faster. With
// `textured` most of them is black.
void addShiningQuads(gltf::Scene& scene, bool textured) {
    materials::Material lamp = coated(0.0F, 1.0F, 0.0F);
    lamp["emissiveFactor"] = {1.0F, 0.8F, 0.5F};
    lamp["emissiveStrength"] = 6.0F;
    if (textured) {
        std::vector<std::uint8_t> texels;
        for (int i = 0; i < 16; ++i) {
            const std::uint8_t value = i % 5 == 0 ? 255 : 10;
            texels.insert(texels.end(), {value, value, value, 255});
        }
        lamp.texture("emissiveTexture").texture = addTexture(scene, 4, 4, texels);
    }
    addQuad(scene, lamp, {-0.5F, 2.2F, -1.8F}, {1, 0, 0}, {0, 0, 1});
    lamp["emissiveStrength"] = 20.0F;
    addQuad(scene, lamp, {2.4F, -0.5F, -1.0F}, {0, 0, -0.5F}, {0.1F, 0.5F, 0});
}

// The map has a bright window to the right and dim light elsewhere.
std::unique_ptr<Environment> windowMap() {
    LinearImage map{32, 16, {}};
    for (std::uint32_t i = 0; i < map.width * map.height; ++i) {
        const std::uint32_t x = i % map.width;
        const std::uint32_t y = i / map.width;
        const bool window = x >= 14 && x < 18 && y >= 4 && y < 6;
        map.pixels.push_back(window ? std::array<float, 4>{6.0F, 6.0F, 5.0F, 1.0F}
                                    : std::array<float, 4>{0.1F, 0.15F, 0.2F, 1.0F});
    }
    return must(Environment::create(sharedContext(), std::move(map), {.sampled = true}));
}

enum class Kind { Punctual, Sized, EnvironmentMap, Sky, Emissive, TexturedEmissive };

std::string nameOf(Kind kind) {
    constexpr const char* kNames[] = {"Punctual", "Sized",    "EnvironmentMap",
                                      "Sky",      "Emissive", "TexturedEmissive"};
    return kNames[static_cast<std::size_t>(kind)];
}

gltf::Scene sceneOf(Kind kind) {
    gltf::Scene scene = yard();
    if (kind == Kind::Punctual || kind == Kind::Sized) {
        addLamps(scene);
    }
    if (kind == Kind::Emissive || kind == Kind::TexturedEmissive) {
        addShiningQuads(scene, kind == Kind::TexturedEmissive);
    }
    return scene;
}

compiler::CompileSettings settingsOf(std::optional<std::uint32_t> lights, std::uint32_t strategies) {
    compiler::CompileSettings settings;
    settings.strategies = strategies;
    settings.plan.merge = compiler::MergePolicy::All;
    settings.effects = {false, compiler::builtinEffects({"shadow", "reflection", "indirect-diffuse"})};
    settings.effects.maxReflectionRoughness = 1.0F;
    settings.maxBounces = kBounces;
    settings.emissiveLights = compiler::EmissiveLights::On;
    settings.lightSamples = lights;
    return settings;
}

// A scene with a renderer that is kept from picture to picture.
class Yard {
public:
    Yard(const gltf::Scene& scene, const compiler::CompileSettings& settings, package::Strategy strategy,
         bool sized = false)
        : loaded_(scene, settings,
                  [&](session::SceneViewData& data) {
                      for (LightView& light : data.lights) {
                          const bool sun = light.type == LightView::Type::Directional;
                          light.size = sized ? (sun ? 0.1F : 0.25F) : 0.0F;
                      }
                  }),
          setup_(defaultSetup(scene, 8, 6)) {
        setup_.frame.maxReflectionRoughness = 1.0F;
        setup_.frame.sky = uniformSky(0.0F);
        RendererOptions options;
        options.strategy = strategy;
        options.bounces = kBounces;
        options.width = setup_.width;
        options.height = setup_.height;
        renderer_ = loaded_.makeRenderer(options);
    }

    FrameOptions& frame() {
        return setup_.frame;
    }
    LinearImage render(std::uint32_t samples, std::uint32_t seed) {
        FrameOptions frame = setup_.frame;
        frame.seed = seed;
        return drawn(*renderer_, frame, samples);
    }

private:
    LoadedScene loaded_;
    RenderSetup setup_;
    std::unique_ptr<Renderer> renderer_;
};

// Returns the slope of a line through (log2 2, y), (log2 4, y) and so on.
double slopeOf(const std::vector<double>& values) {
    const double middle = 0.5 * (static_cast<double>(values.size()) - 1.0);
    double products = 0.0;
    double squares = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double x = static_cast<double>(i) - middle;
        products += x * values[i];
        squares += x * x;
    }
    return products / squares;
}

class PathConvergence : public ::testing::TestWithParam<Kind> {};

// Over five octaves the error falls with the root of the samples, or a little faster where the sequence
// helps.
TEST_P(PathConvergence, ErrorFallsWithTheRootOfTheSamples) {
    const Kind kind = GetParam();
    const gltf::Scene scene = sceneOf(kind);
    compiler::CompileSettings settings = settingsOf(1, package::kStrategyUber);
    settings.environmentMap = kind == Kind::EnvironmentMap;
    const std::unique_ptr<Environment> map = settings.environmentMap ? windowMap() : nullptr;
    Yard yard(scene, settings, package::kStrategyUber, kind == Kind::Sized);
    yard.frame().environment = map.get();
    if (kind == Kind::Sky) {
        yard.frame().sky = SkyView{};
    }
    const LinearImage reference = yard.render(2048, 1);
    std::vector<double> errors;
    for (std::uint32_t samples = 2; samples <= 64; samples *= 2) {
        double squares = 0.0;
        constexpr std::uint32_t kSeeds = 4;
        for (std::uint32_t seed = 2; seed < 2 + kSeeds; ++seed) {
            squares += meanSquare(yard.render(samples, seed), reference) / kSeeds;
        }
        errors.push_back(0.5 * std::log2(squares));
        std::printf("%u samples: error %.5f\n", samples, std::sqrt(squares));
    }
    const double slope = slopeOf(errors);
    std::printf("slope %.3f\n", slope);
    EXPECT_GT(slope, -0.7);
    EXPECT_LT(slope, -0.4);
}

// By day each kind of light that is sampled in another way.
INSTANTIATE_TEST_SUITE_P(
    Lights, PathConvergence,
    ::testing::ValuesIn(test::nightly()
                            ? std::vector{Kind::Punctual, Kind::Sized, Kind::EnvironmentMap, Kind::Sky,
                                          Kind::Emissive, Kind::TexturedEmissive}
                            : std::vector{Kind::Sized, Kind::EnvironmentMap, Kind::TexturedEmissive}),
    [](const auto& parameter) { return nameOf(parameter.param); });

struct Estimate {
    std::string name;
    double mean = 0.0;
    double error = 0.0;  // standard error of the mean
};

Estimate estimateOf(std::string name, Yard& yard, std::uint32_t firstSeed) {
    constexpr int kSeeds = 12;
    std::vector<double> means;
    for (int seed = 0; seed < kSeeds; ++seed) {
        means.push_back(meanOf(yard.render(16, firstSeed + static_cast<std::uint32_t>(seed))));
    }
    Estimate estimate{std::move(name)};
    for (const double mean : means) {
        estimate.mean += mean / kSeeds;
    }
    double squares = 0.0;
    for (const double mean : means) {
        squares += (mean - estimate.mean) * (mean - estimate.mean);
    }
    estimate.error = std::sqrt(squares / (kSeeds * (kSeeds - 1.0)));
    return estimate;
}

// All kinds of light but a map, each way with seeds of its own. By day Paths compares the strategies'
// pictures.
TEST(PathMeans, AreThoseOfEveryStrategyAndNumberOfLights) {
    gltf::Scene scene = yard();
    addLamps(scene);
    addShiningQuads(scene, true);
    std::vector<Estimate> estimates;
    std::uint32_t seed = 100;
    for (const std::optional<std::uint32_t> lights :
         {std::optional<std::uint32_t>(0), std::optional<std::uint32_t>(1)}) {
        for (const package::Strategy strategy : package::strategies()) {
            const bool all = test::nightly() && lights == 0U;
            if (!all && strategy != package::kStrategyVisibility) {
                continue;
            }
            Yard yard(scene, settingsOf(lights, strategy), strategy, true);
            yard.frame().sky = SkyView{};
            const std::string name =
                std::string(package::nameOf(strategy)) + (lights == 1U ? ", one light" : "");
            estimates.push_back(estimateOf(name, yard, seed));
            seed += 100;
            std::printf("%s: %.5f ± %.5f\n", name.c_str(), estimates.back().mean, estimates.back().error);
            EXPECT_GT(estimates.back().error, 0.0);
        }
    }
    for (const Estimate& a : estimates) {
        for (const Estimate& b : estimates) {
            // As seeds are fixed, a bias shows and chance does not.
            EXPECT_NEAR(a.mean, b.mean, 4.0 * std::hypot(a.error, b.error)) << a.name << " and " << b.name;
        }
    }
}

}  // namespace
