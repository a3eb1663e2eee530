// Lights that a hierarchy chooses: the means of their pictures are those of all lights.
#include "render/hit_kernel.h"
#include "render/light_pictures.h"
#include "render/pixel_test.h"
#include "support/effect_bits.h"
#include "support/must.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <map>
#include <random>
#include <vector>

namespace {

using namespace glint;
using namespace glint::testing;

// The words that light_tree.comp writes for a point.
constexpr std::uint32_t kWordsOfChoice = 6;
// A packed normal of surfaces that take light of both sides (light/tree.glsl).
constexpr std::uint32_t kBothSides = 0x80008000U;

// A floor and a wall that throws shadows, below 150 lights of every kind: points with and without a range,
// spots, a sun.
gltf::Scene hallOfLights(std::size_t count = 150) {
    gltf::Scene scene = sceneWithCamera();
    materials::Material material;
    material["metallicFactor"] = 0.0F;
    material["roughnessFactor"] = 0.7F;
    material["baseColorFactor"] = {0.5F, 0.5F, 0.5F, 1.0F};
    const int matte = addMaterial(scene, material);
    addQuad(scene, matte, {-4, -1, 0}, {8, 0, 0}, {0, 0, -8});
    addQuad(scene, matte, {-0.5, -1, -3}, {1, 0, 0}, {0, 1, 0});
    std::mt19937 random(7);
    std::uniform_real_distribution<float> unit(0.0F, 1.0F);
    for (std::size_t i = 0; i < count; ++i) {
        gltf::Light light;
        light.type = i % 3 == 0 ? gltf::LightType::Spot : gltf::LightType::Point;
        light.position = {8.0F * unit(random) - 4.0F, 0.5F + 2.0F * unit(random), -8.0F * unit(random)};
        light.intensity = 0.05F + unit(random) * unit(random);
        light.color = {unit(random), 0.5F, unit(random)};
        light.range = i % 4 == 0 ? 3.0F : 0.0F;
        light.direction = {0.0F, -1.0F, 0.0F};
        light.innerConeAngle = 0.3F;
        light.outerConeAngle = 0.8F;
        scene.lights.push_back(light);
    }
    addDirectionalLight(scene, {0.3F, -0.9F, -0.3F}, 0.2F);
    return scene;
}

LoadedScene load(const gltf::Scene& scene, std::optional<std::uint32_t> lights,
                 std::uint32_t strategies = package::kStrategyUber) {
    compiler::CompileSettings settings;
    settings.strategies = strategies;
    settings.plan.merge = compiler::MergePolicy::All;
    settings.lightSamples = lights;
    return LoadedScene(scene, settings);
}

// light_tree.comp for surfaces that take so many samples.
Result<std::unique_ptr<HitKernel>> kernelOf(const gltf::Scene& scene, const LoadedScene& loaded,
                                            std::uint32_t samples) {
    compiler::CompileSettings settings;
    settings.lightSamples = samples;
    return HitKernel::create(scene, loaded, "light_tree.comp", settings);
}

RenderSetup setupOf(const gltf::Scene& scene, std::uint32_t samples, std::uint32_t seed) {
    RenderSetup setup = defaultSetup(scene, 24, 16);
    setup.frame.sky = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    setup.samples = samples;
    setup.frame.seed = seed;
    return setup;
}

// The pictures of shadow rays that wait in memory are those of rays that the cases trace: with more rays than
// a round holds, lights of several points, bands, and both tracers.
TEST(FirstShadows, WaitWithoutAChange) {
    const gltf::Scene scene = hallOfLights(5);
    const auto giveSizes = [](session::SceneViewData& data) {
        for (LightView& light : data.lights) {
            light.size = light.type == LightView::Type::Directional ? 0.01F : 0.2F;
        }
    };
    compiler::CompileSettings settings;
    settings.strategies = package::kStrategyUber;
    settings.tracers = package::kAllTracers;
    settings.plan.merge = compiler::MergePolicy::All;
    settings.firstShadows = package::ShadowPlacement::Inline;
    const LoadedScene traced(scene, settings, giveSizes);
    settings.firstShadows = package::ShadowPlacement::Deferred;
    const LoadedScene waiting(scene, settings, giveSizes);
    EXPECT_EQ(traced.package().shape().firstShadowRays, 0U);
    EXPECT_EQ(waiting.package().shape().firstShadowRays, 4U);
    RenderSetup setup = setupOf(scene, 2, 3);
    setup.frame.shadowSamples = 3;
    RendererOptions options;
    options.strategy = package::kStrategyUber;
    options.countsLight = true;
    options.bands = 2;
    Renderer::Counters counted;
    const LinearImage expected = traced.render(options, setup, &counted);
    EXPECT_EQ(counted.shadowRounds, 0U);
    EXPECT_EQ(counted.of(package::kEffectShadow).waited, 0U);
    for (const package::Tracer tracer : package::kTracers) {
        options.tracer = tracer;
        Renderer::Counters counters;
        const LinearImage image = waiting.render(options, setup, &counters);
        EXPECT_EQ(counters.shadowRounds, 5U) << "six lights of three points";
        EXPECT_EQ(counters.of(package::kEffectShadow).waited, counted.of(package::kEffectShadow).rays);
        ASSERT_EQ(image.pixels.size(), expected.pixels.size());
        for (std::size_t i = 0; i < image.pixels.size(); ++i) {
            for (std::size_t channel = 0; channel < 3; ++channel) {
                EXPECT_NEAR(image.pixels[i][channel], expected.pixels[i][channel],
                            1e-5F * (1.0F + expected.pixels[i][channel]))
                    << nameOf(tracer) << ", pixel " << i;
            }
        }
    }
}

// The lights of a frame decide the number of rounds, so the timer has room for one stretch for all but the
// first.
TEST(FirstShadows, HaveOneTimeForFurtherRounds) {
    const gltf::Scene scene = hallOfLights(12);
    compiler::CompileSettings settings;
    settings.strategies = package::kStrategyUber;
    settings.plan.merge = compiler::MergePolicy::All;
    settings.firstShadows = package::ShadowPlacement::Deferred;
    const LoadedScene loaded(scene, settings);
    RenderSetup setup = setupOf(scene, 1, 3);
    setup.frame.timing = Timing::Passes;
    RendererOptions options;
    options.strategy = package::kStrategyUber;
    options.width = setup.width;
    options.height = setup.height;
    options.bands = 2;
    const auto renderer = loaded.makeRenderer(options);
    ASSERT_TRUE(renderer->renderSamples(setup.frame, 1));
    EXPECT_EQ(must(renderer->counters()).shadowRounds, 4U);
    const std::vector<PassTiming> timings = must(renderer->timings());
    EXPECT_EQ(std::ranges::count(timings, "further shadow rounds", &PassTiming::name), 2);
    EXPECT_EQ(std::ranges::count(timings, "first shadows", &PassTiming::name), 2);
}

// With jitter each sample sees other points, so the reference has many samples too.
TEST(ManyLights, ChosenLightsConvergeToAll) {
    const gltf::Scene scene = hallOfLights();
    const LoadedScene all = load(scene, 0);
    EXPECT_EQ(all.package().lightSamples(), 0U);
    const LinearImage reference = all.render(package::kStrategyUber, setupOf(scene, 256, 1));
    for (const std::uint32_t lights : {1U, 4U}) {
        const LoadedScene chosen = load(scene, lights);
        EXPECT_EQ(chosen.package().lightSamples(), lights);
        constexpr int kSeeds = 8;
        double sum = 0.0;
        double squares = 0.0;
        std::map<std::uint32_t, double> errors;
        for (int seed = 0; seed < kSeeds; ++seed) {
            const LinearImage image = chosen.render(package::kStrategyUber, setupOf(scene, 64, 10 + seed));
            const double mean = meanOf(image);
            sum += mean;
            squares += mean * mean;
            for (const std::uint32_t samples : {4U, 64U}) {
                errors[samples] += rootMeanSquare(
                    samples == 64 ? image
                                  : chosen.render(package::kStrategyUber, setupOf(scene, samples, 10 + seed)),
                    reference);
            }
        }
        const double mean = sum / kSeeds;
        const double deviation = std::sqrt(std::max(squares / kSeeds - mean * mean, 0.0) / (kSeeds - 1));
        EXPECT_NEAR(mean, meanOf(reference), 4.0 * deviation + 1e-3 * mean) << lights << " lights";
        // 16 times the samples: a quarter of the error, or less where the sequence helps.
        const double ratio = errors[4] / errors[64];
        EXPECT_GT(ratio, 3.0) << lights << " lights";
        EXPECT_LT(ratio, 8.0) << lights << " lights";
    }
}

TEST(ManyLights, StrategiesChooseTheSameLights) {
    gltf::Scene scene = hallOfLights();
    materials::Material mirror = mirrorMaterial();
    addQuad(scene, mirror, {1, -1, -4}, {1.5, 0, 0.5}, {0, 1.5, 0});
    const LoadedScene loaded = load(scene, 2, package::allStrategies());
    const RenderSetup setup = setupOf(scene, 4, 3);
    const LinearImage reference = loaded.render(package::kStrategyUber, setup);
    for (const package::Strategy strategy : package::strategies()) {
        if ((package::tracersOf(strategy, package::kTracerRayQuery) & package::kTracerRayQuery) != 0) {
            expectSameImage(loaded.render(strategy, setup), reference,
                            std::string(package::nameOf(strategy)));
        }
    }
}

// A light never has two samples, so as many samples as lights are all of them, in one sample of a pixel.
TEST(ManyLights, AsManySamplesAsLightsHaveNoNoise) {
    constexpr std::uint32_t kLights = 24;
    const gltf::Scene scene = hallOfLights(kLights);
    const LoadedScene all = load(scene, 0);
    const LinearImage reference = all.render(package::kStrategyUber, setupOf(scene, 1, 1));
    const LoadedScene chosen = load(scene, kLights);
    EXPECT_LT(rootMeanSquare(chosen.render(package::kStrategyUber, setupOf(scene, 1, 1)), reference), 1e-6);
}

TEST(ManyLights, AutoTakesAllOfFew) {
    const LoadedScene few = load(hallOfLights(8), std::nullopt);
    EXPECT_EQ(few.package().lightSamples(), 0U);
    const LoadedScene many = load(hallOfLights(300), std::nullopt);
    EXPECT_GT(many.package().lightSamples(), 0U);
}

// Lights with a range, which start where none of their light arrives. Without new bounds the hierarchy would
// choose none of them.
TEST(ManyLights, TheHierarchyFollowsLightsThatMove) {
    gltf::Scene scene = hallOfLights(60);
    scene.lights.pop_back();  // the sun
    for (gltf::Light& light : scene.lights) {
        light.range = 3.0F;
    }
    const LoadedScene still = load(scene, 0);
    const LinearImage reference = still.render(package::kStrategyUber, setupOf(scene, 64, 1));

    compiler::CompileSettings settings;
    settings.strategies = package::kStrategyUber;
    settings.plan.merge = compiler::MergePolicy::All;
    settings.lightSamples = 4;
    std::vector<InstanceView> instances;
    std::vector<LightView> lights;
    const LoadedScene moving(scene, settings, [&](session::SceneViewData& data) {
        data.moves = true;
        instances = data.instances;
        lights = data.lights;
        for (LightView& light : data.lights) {
            light.position[0] += 100.0F;
        }
    });
    const double away = meanOf(moving.render(package::kStrategyUber, setupOf(scene, 1, 1)));
    EXPECT_EQ(away, 0.0) << "out of range";
    must(moving.gpuScene().updateAndWait({instances, lights}));
    const LinearImage image = moving.render(package::kStrategyUber, setupOf(scene, 64, 1));
    EXPECT_NEAR(meanOf(image), meanOf(reference), 0.02 * meanOf(reference));
}

// At points in and around the hall, on surfaces of any direction and on such as take light of both sides: the
// samples that the chosen light expects are those that are evaluated, every light that arrives can be chosen,
// and lights are chosen as often as that. What the sum lacks of all samples is how often a way through the
// tree ends at nodes that bring nothing.
void expectChancesOfTheChoice(std::uint32_t samples) {
    const gltf::Scene scene = hallOfLights();
    const LoadedScene loaded = load(scene, samples);
    const std::unique_ptr<HitKernel> kernel = must(kernelOf(scene, loaded, samples));
    const auto all = static_cast<float>(samples);
    std::mt19937 random(5);
    std::uniform_real_distribution<float> unit(0.0F, 1.0F);
    std::vector<gpu::RayRecord> rays(4096);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const bool frequent = i >= 2048;  // all at one point, along the line of samples
        const bool faces = i < 1024;
        rays[i].origin = frequent ? gpu::vec3{0.5F, -1.0F, -3.0F}
                                  : gpu::vec3{12.0F * unit(random) - 6.0F, 4.0F * unit(random) - 1.0F,
                                              4.0F - 16.0F * unit(random)};
        rays[i].target = faces ? static_cast<std::uint32_t>(random()) : kBothSides;
        const float place = frequent ? (static_cast<float>(i - 2048) + 0.5F) / 2048.0F : unit(random);
        rays[i].direction = {all * place, unit(random), unit(random)};
    }
    const auto count = static_cast<std::uint32_t>(rays.size());
    const std::vector<std::uint32_t> words =
        must(kernel->run({}, rays, count, std::size_t{kWordsOfChoice} * count));
    std::map<std::uint32_t, std::pair<double, int>> chosen;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const std::uint32_t* const word = words.data() + kWordsOfChoice * i;
        const auto chance = std::bit_cast<float>(word[1]);
        EXPECT_EQ(word[4], 0U) << "lights that arrive at point " << i << " can't be chosen";
        const auto sum = std::bit_cast<float>(word[3]);
        EXPECT_LE(sum, all * (1.0F + 2e-5F)) << "point " << i;
        EXPECT_TRUE(sum > 0.4F * all || rays[i].target != kBothSides) << "point " << i << ", " << sum;
        EXPECT_LE(chance, 1.0F + 1e-5F) << "point " << i;
        if (chance > 0.0F) {
            EXPECT_NEAR(std::bit_cast<float>(word[2]) / chance, 1.0F, 1e-5F) << "point " << i;
        }
        if (i >= 2048) {
            std::pair<double, int>& seen = chosen[chance > 0.0F ? word[0] : gpu::kLightLeaf];
            seen.first = chance > 0.0F ? chance : all - sum;
            ++seen.second;
        }
    }
    for (const auto& [light, seen] : chosen) {
        EXPECT_NEAR(seen.second, 2048.0 * seen.first / samples, 2.0) << "light " << light;
    }
}

TEST(ManyLights, ChancesAreThoseOfTheChoice) {
    for (const std::uint32_t samples : {1U, 8U}) {
        SCOPED_TRACE(samples);
        expectChancesOfTheChoice(samples);
    }
}

// Surfaces among lights are close to some lights of the largest nodes. The variance of one sample without
// shadows, over the square of its mean, for lights that fill a volume and for lights in groups.
TEST(ManyLights, LightsAreChosenByWhatTheyBring) {
    for (const bool groups : {false, true}) {
        gltf::Scene scene = sceneWithCamera();
        addQuad(scene, materials::Material(), {-10, 0, -10}, {20, 0, 0}, {0, 0, 20});
        std::mt19937 random(11);
        std::uniform_real_distribution<float> unit(0.0F, 1.0F);
        for (int i = 0; i < 1000; ++i) {
            gltf::Light light;
            light.type = gltf::LightType::Point;
            light.intensity = unit(random);
            light.color = {1.0F, 1.0F, 1.0F};
            const float spread = groups ? 0.5F : 20.0F;
            const auto corner = [&](int group) {
                return groups ? 4.0F * static_cast<float>(group) - 10.0F : -10.0F;
            };
            light.position = {corner(i % 5) + spread * unit(random), 0.5F + 2.0F * unit(random),
                              corner(i / 5 % 5) + spread * unit(random)};
            scene.lights.push_back(light);
        }
        const LoadedScene loaded = load(scene, 1);
        const std::unique_ptr<HitKernel> kernel = must(kernelOf(scene, loaded, 1));
        constexpr std::uint32_t kCount = 512;
        std::vector<gpu::RayRecord> rays(kCount);
        for (gpu::RayRecord& ray : rays) {
            ray.origin = {20.0F * unit(random) - 10.0F, 0.0F, 20.0F * unit(random) - 10.0F};
            ray.target = 0x7FFF0000U;  // up
        }
        const std::vector<std::uint32_t> words =
            must(kernel->run({}, rays, kCount, std::size_t{kWordsOfChoice} * kCount));
        double moments = 0.0;
        for (std::uint32_t i = 0; i < kCount; ++i) {
            moments += std::bit_cast<float>(words[kWordsOfChoice * i + 5]) / kCount;
        }
        std::printf("lights %s: variance %.2f\n", groups ? "in groups" : "everywhere", moments - 1.0);
        EXPECT_LT(moments - 1.0, 0.3) << (groups ? "in groups" : "everywhere");
    }
}

// Numbers that lie on a grid, as all random numbers do, choose no light whose probability is far below the
// distance of the grid: its light is divided by that probability.
TEST(ManyLights, CoarseNumbersChooseNoLightThatIsNearlyImpossible) {
    gltf::Scene scene = hallOfLights();
    scene.lights.pop_back();  // the sun
    for (gltf::Light& light : scene.lights) {
        light.intensity *= static_cast<float>(std::pow(10.0, 3.0 * light.position[0]));
    }
    const LoadedScene loaded = load(scene, 1);
    const std::unique_ptr<HitKernel> kernel = must(kernelOf(scene, loaded, 1));
    constexpr std::uint32_t kCount = 4096;
    std::mt19937 random(5);
    std::uniform_real_distribution<float> unit(0.0F, 1.0F);
    std::vector<gpu::RayRecord> rays(kCount);
    for (std::uint32_t i = 0; i < kCount; ++i) {
        rays[i].origin = {0.5F, -1.0F, -3.0F};
        rays[i].target = kBothSides;
        rays[i].direction = {static_cast<float>(i) / kCount, unit(random), unit(random)};
    }
    const std::vector<std::uint32_t> words =
        must(kernel->run({}, rays, kCount, std::size_t{kWordsOfChoice} * kCount));
    float least = 1.0F;
    for (std::uint32_t i = 0; i < kCount; ++i) {
        const auto probability = std::bit_cast<float>(words[kWordsOfChoice * i + 1]);
        least = probability > 0.0F ? std::min(least, probability) : least;
    }
    std::printf("the least probability of a chosen light: %.1e\n", static_cast<double>(least));
    EXPECT_GT(least, 1e-9F);
}

}  // namespace
