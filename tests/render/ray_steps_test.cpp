// The steps that a host records for rays of its own.
#include "base/files.h"
#include "context/commands.h"
#include "render/harness.h"
#include "render/light_pictures.h"
#include "render/rooms.h"
#include "render/scene_builder.h"
#include "render/traced_frame.h"
#include "renderer/hit_passes.h"
#include "renderer/renderer.h"
#include "resolve/host.h"
#include "support/must.h"
#include "support/temporary_folder.h"

#include <glint/environment.h>
#include <glint/steps.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

namespace {

using namespace glint;
using namespace glint::testing;

// Rays of a Renderer with their hits, and the light that it found for them, by slot.
struct KnownRays {
    std::vector<RaySteps::Ray> rays;
    std::vector<RaySteps::Hit> hits;
    std::vector<RaySteps::Radiance> answers;
};

template <typename T>
std::vector<T> arrayOf(const std::vector<std::uint8_t>& bytes, std::size_t count) {
    std::vector<T> result(count);
    std::memcpy(result.data(), bytes.data(), count * sizeof(T));
    return result;
}

// Traces the reflections of a scene as Renderer does, in paths of that many bounces.
KnownRays knownRays(const gltf::Scene& scene, const RenderSetup& setup, std::uint32_t bounces,
                    compiler::SkyLight sky = compiler::SkyLight::Off) {
    compiler::CompileSettings settings;
    settings.strategies = package::kStrategyVisibility;
    settings.tracers = package::kAllTracers;
    settings.plan.merge = compiler::MergePolicy::All;
    settings.plan.keys.alpha = package::AlphaPolicy::Tested;
    // Rays keep their origins in packages for several bounces, if the frame has one. So the answers to longer
    // paths come from another frame.
    settings.maxBounces = std::max(bounces, 2U);
    settings.hitRecord = package::HitRecordFormat::Full;
    settings.emissiveLights = compiler::EmissiveLights::Off;
    settings.skyLight = sky;
    settings.environmentMap = setup.frame.environment != nullptr;
    const LoadedScene loaded(scene, settings);
    KnownRays known;
    RendererOptions options;
    options.strategy = package::kStrategyVisibility;
    options.width = setup.width;
    options.height = setup.height;
    const auto renderer = loaded.makeRenderer(options);
    options.bounces = bounces;
    const auto deeper = loaded.makeRenderer(options);
    if (!renderer || !deeper || !renderer->render(setup.frame) || !deeper->render(setup.frame)) {
        return known;
    }
    Renderer::State& state = renderer->state();
    Result<CommandRunner> runner = CommandRunner::create(state.context);
    const auto rays = readRays(*renderer, renderer->counters()->rays);
    const auto hits = readFrameBuffer(state, *runner, state.frame.hits);
    const auto radiance = readFrameBuffer(deeper->state(), *runner, deeper->state().frame.radiance);
    EXPECT_TRUE(rays && hits && radiance);
    known.hits = arrayOf<RaySteps::Hit>(*hits, rays->size());
    for (const gpu::RayRecord& ray : *rays) {
        known.rays.push_back({{ray.origin.x, ray.origin.y, ray.origin.z},
                              ray.target,
                              {ray.direction.x, ray.direction.y, ray.direction.z},
                              ray.coneWidth,
                              ray.coneSpread});
    }
    // Samples without a ray have no radiance.
    const auto answers = arrayOf<RaySteps::Radiance>(*radiance, std::size_t{setup.width} * setup.height);
    known.answers.resize(answers.size());
    for (const RaySteps::Ray& ray : known.rays) {
        known.answers[ray.slot] = answers[ray.slot];
    }
    return known;
}

// The things that a host asks of its steps.
struct Asked {
    bool apart = false;       // the steps one by one, with the count on the device
    bool givesHits = false;   // those of the host's list
    bool visibility = false;  // the rays of the other list
    std::uint32_t bounces = 0;
};

// A host: a pipeline layout with Glint's scene in set 2, an environment map in set 1 if the package reads
// one, and push constants at byte 16, a list of rays and its answers. For a package without textures that
// takes its structure by address, the layout has no set.
class Host {
public:
    Host(const LoadedScene& loaded, const std::vector<RaySteps::Ray>& rays, std::size_t slots,
         std::size_t answerBytes)
        : Host(loaded, slots, answerBytes) {
        list_ = upload(rays);
        count(rays.size());
    }
    // A host that asks for visibility, with a float or more for each slot.
    Host(const LoadedScene& loaded, const std::vector<RaySteps::VisibilityRay>& rays, std::size_t answerBytes)
        : Host(loaded, rays.size(), answerBytes) {
        list_ = upload(rays);
        count(rays.size());
    }

    void give(const std::vector<RaySteps::Hit>& hits) {
        hits_ = upload(hits);
    }

    std::unique_ptr<RaySteps> makeSteps(RaySteps::Options options) {
        scene_ = must(EngineScene::share(sharedContext(), loaded_.gpuScene()));
        options.layout = layout_.get();
        options.pushStages = kStages;
        options.maxRays = static_cast<std::uint32_t>(slots_);
        return must(RaySteps::create(sharedContext(), loaded_.package(), *scene_, options));
    }

    // Records the steps and waits.
    template <typename Answer>
    std::vector<Answer> ask(RaySteps& steps, const FrameOptions& frame, const Asked& asked) {
        RaySteps::Batch batch = batchOf(frame, asked);
        Result<CommandRunner> runner = CommandRunner::create(context_);
        const Result<VkCommandBuffer> commands = runner->begin();
        const VkDescriptorSet set = loaded_.gpuScene().descriptorSet();
        const VkPipelineBindPoint points[] = {VK_PIPELINE_BIND_POINT_COMPUTE,
                                              VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR};
        if (frame.environment != nullptr) {
            const VkDescriptorImageInfo map = frame.environment->image();
            writeImages(context_, sky_.set, loaded_.package().bindings().environment,
                        VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, {&map, 1});
        }
        for (const VkPipelineBindPoint point :
             hasSet_ ? std::span(points) : std::span<const VkPipelineBindPoint>()) {
            context_.vk.CmdBindDescriptorSets(*commands, point, layout_.get(), 2, 1, &set, 0, nullptr);
            if (frame.environment != nullptr) {
                context_.vk.CmdBindDescriptorSets(*commands, point, layout_.get(), 1, 1, &sky_.set, 0,
                                                  nullptr);
            }
        }
        if (asked.apart) {
            batch.rayCount = 0;
            batch.countAddress = count_.address;
            must(steps.begin(*commands, batch));
            steps.trace(*commands);
            steps.order(*commands);
            steps.shade(*commands);
        } else {
            must(steps.record(*commands, batch));
        }
        recordDependency(context_, *commands,
                         {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT,
                          VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT});
        EXPECT_TRUE(runner->submitAndWait());
        std::vector<Answer> read(slots_);
        std::memcpy(read.data(), answers_.mapped, slots_ * sizeof(Answer));
        return read;
    }

    // Does so with steps of its own.
    template <typename Answer>
    std::vector<Answer> answers(const RaySteps::Options& options, const FrameOptions& frame) {
        return ask<Answer>(*makeSteps(options), frame, {});
    }

    RaySteps::Batch batchOf(const FrameOptions& frame, const Asked& asked) const {
        RaySteps::Batch batch;
        batch.rays = list_.address;
        batch.hits = asked.givesHits ? hits_.address : 0;
        batch.visibility = asked.visibility;
        batch.bounces = asked.bounces;
        batch.answers = answers_.address;
        batch.rayCount = rays_;
        batch.sky = frame.sky;
        batch.environment = frame.environment;
        batch.environmentRotation = frame.environmentRotation;
        batch.environmentIntensity = frame.environmentIntensity;
        batch.sampleIndex = frame.sampleIndex;
        batch.seed = frame.seed;
        batch.tlas = loaded_.gpuScene().state().tlas.address;
        return batch;
    }

    // Makes another layout with the same set, and lets the steps use it.
    void changeLayout(RaySteps& steps) {
        UniquePipelineLayout next = makeLayout(32 + RaySteps::kPushBytes);
        must(steps.setLayout(next.get(), kStages));
        layout_ = std::move(next);
    }

    VkPipelineLayout layout() const {
        return layout_.get();
    }
    static constexpr VkShaderStageFlags kStages = VK_SHADER_STAGE_ALL;

private:
    Host(const LoadedScene& loaded, std::size_t slots, std::size_t answerBytes)
        : context_(sharedContext().state()),
          pool_(context_),
          loaded_(loaded),
          slots_(slots),
          hasSet_(loaded.package().bindings().tlas != package::Bindings::kByAddress ||
                  !loaded.package().scene(0).textures.empty()) {
        empty_ = must(createSetLayout(context_, {}));
        const VkDescriptorSetLayoutBinding map{loaded.package().bindings().environment,
                                               VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, kStages,
                                               nullptr};
        skyLayout_ = must(createSetLayout(context_, {&map, 1}));
        sky_ = must(createSet(context_, skyLayout_.get(), {&map, 1}, true));
        layout_ = makeLayout(16 + RaySteps::kPushBytes);
        answers_ = make(slots * answerBytes, MemoryUse::Readback);
    }

    UniquePipelineLayout makeLayout(std::uint32_t pushBytes) const {
        const VkDescriptorSetLayout sets[] = {empty_.get(), skyLayout_.get(),
                                              loaded_.gpuScene().descriptorSetLayout()};
        return must(
            createPipelineLayout(context_, std::span(sets).first(hasSet_ ? 3 : 0), {kStages, 0, pushBytes}));
    }

    Buffer make(std::size_t bytes, MemoryUse use) {
        return must(createBuffer(context_, pool_, std::max<std::size_t>(bytes, 16),
                                 VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, use));
    }

    template <typename T>
    Buffer upload(const std::vector<T>& values) {
        Buffer buffer = make(values.size() * sizeof(T), MemoryUse::Upload);
        std::memcpy(buffer.mapped, values.data(), values.size() * sizeof(T));
        return buffer;
    }

    void count(std::size_t rays) {
        rays_ = static_cast<std::uint32_t>(rays);
        count_ = upload(std::vector{rays_});
    }

    Context::State& context_;
    MemoryPool pool_;
    const LoadedScene& loaded_;
    std::uint32_t rays_ = 0;
    std::size_t slots_;
    bool hasSet_;
    UniqueSetLayout empty_;
    UniqueSetLayout skyLayout_;
    DescriptorSet sky_;
    UniquePipelineLayout layout_;
    std::unique_ptr<EngineScene> scene_;
    Buffer list_;
    Buffer hits_;
    Buffer count_;
    Buffer answers_;
};

compiler::CompileSettings stepSettings() {
    compiler::CompileSettings settings;
    settings.passes = package::Passes::Steps;
    settings.strategies = package::allStrategies();
    settings.tracers = package::kAllTracers;
    settings.plan.merge = compiler::MergePolicy::All;
    settings.plan.keys.alpha = package::AlphaPolicy::Tested;
    settings.bindings.sceneSet = 2;
    settings.bindings.pushOffset = 16;
    return settings;
}

struct Way {
    package::Strategy strategy;
    package::Tracer tracer;
};
constexpr Way kAllWays[] = {{package::kStrategyUber, package::kTracerRayQuery},
                            {package::kStrategyUber, package::kTracerRayPipeline},
                            {package::kStrategyVisibility, package::kTracerRayQuery},
                            {package::kStrategyVisibility, package::kTracerRayPipeline},
                            {package::kStrategySortedUber, package::kTracerRayQuery},
                            {package::kStrategyHitShaders, package::kTracerRayPipeline}};

// Those whose tracer the device has.
std::vector<Way> ways() {
    std::vector<Way> result;
    for (const Way& way : kAllWays) {
        if ((sharedContext().handles().tracers & way.tracer) != 0) {
            result.push_back(way);
        }
    }
    EXPECT_FALSE(result.empty());
    return result;
}

// Returns how many answers differ from those of a renderer.
std::size_t countFar(const KnownRays& known, const std::vector<RaySteps::Radiance>& answers,
                     float tolerance) {
    std::size_t far = 0;
    for (const RaySteps::Ray& ray : known.rays) {
        const RaySteps::Radiance& mine = answers.at(ray.slot);
        const RaySteps::Radiance& renderer = known.answers[ray.slot];
        bool near = mine.path == renderer.path;
        for (std::size_t i = 0; i < 3; ++i) {
            near = near && std::abs(mine.radiance[i] - renderer.radiance[i]) <=
                               tolerance * std::max(1.0F, renderer.radiance[i]);
        }
        far += near ? 0 : 1;
    }
    return far;
}

// The rays are traced, and then their hits are given, by whatever strategy takes them.
TEST(RaySteps, AnswerAHostsRaysAndHitsAsARendererDoes) {
    const gltf::Scene scene = roomWithFence();
    const RenderSetup setup = defaultSetup(scene, 48, 27);
    const KnownRays known = knownRays(scene, setup, 1);
    ASSERT_GT(known.rays.size(), 100U);
    for (const auto record : {package::HitRecordFormat::Full, package::HitRecordFormat::Packed}) {
        compiler::CompileSettings settings = stepSettings();
        settings.hitRecord = record;
        const LoadedScene loaded(scene, settings);
        Host host(loaded, known.rays, known.answers.size(), sizeof(RaySteps::Radiance));
        host.give(known.hits);
        for (const Way& way : ways()) {
            const bool packed = record == package::HitRecordFormat::Packed;
            if (packed && way.strategy != package::kStrategySortedUber) {
                continue;
            }
            SCOPED_TRACE(std::string(nameOf(way.strategy)) + ", " + std::string(nameOf(way.tracer)));
            RaySteps::Options options;
            options.strategy = way.strategy;
            options.tracer = way.tracer;
            options.checkOrder = true;
            const auto steps = host.makeSteps(options);
            for (const bool givesHits : {false, true}) {
                const Asked asked{way.strategy == package::kStrategyVisibility, givesHits};
                if (givesHits && way.strategy == package::kStrategyHitShaders) {
                    EXPECT_EQ(mustFail(steps->begin(VK_NULL_HANDLE, host.batchOf(setup.frame, asked))).id,
                              "ray-steps");
                    continue;
                }
                const auto answers = host.ask<RaySteps::Radiance>(*steps, setup.frame, asked);
                const RaySteps::Counters counters = must(steps->counters());
                EXPECT_EQ(counters.rays, known.rays.size());
                EXPECT_EQ(counters.furtherRays, 0U);
                EXPECT_EQ(counters.orderErrors, 0U);
                EXPECT_EQ(counters.unknownShader, 0U);
                // Packed records round the place on a triangle, which a shadow's edge shows.
                EXPECT_LE(countFar(known, answers, packed ? 1e-2F : 1e-4F),
                          packed ? known.rays.size() / 50 : 0)
                    << (givesHits ? "given" : "traced");
            }
        }
    }
}

// Nothing is traced for a ray whose hit is given: here all rays leave the scene.
TEST(RaySteps, TraceNoRayWhoseHitIsGiven) {
    const gltf::Scene scene = roomWithFence();
    const RenderSetup setup = defaultSetup(scene, 16, 9);
    const KnownRays known = knownRays(scene, setup, 1);
    compiler::CompileSettings settings = stepSettings();
    settings.strategies = package::kStrategyUber | package::kStrategyVisibility;
    const LoadedScene loaded(scene, settings);
    Host host(loaded, known.rays, known.answers.size(), sizeof(RaySteps::Radiance));
    host.give(std::vector<RaySteps::Hit>(known.rays.size()));
    for (const package::Strategy strategy : {package::kStrategyUber, package::kStrategyVisibility}) {
        RaySteps::Options options;
        options.strategy = strategy;
        const auto steps = host.makeSteps(options);
        const auto answers = host.ask<RaySteps::Radiance>(*steps, setup.frame, {.givesHits = true});
        for (const RaySteps::Ray& ray : known.rays) {
            EXPECT_EQ(answers[ray.slot].path, 3.0F);
        }
    }
}

// Paths of three bounces bring the light that a renderer's bring, and with a limit of one bounce the light of
// the first hits. Afterwards the pipelines are made for another layout.
TEST(RaySteps, FollowPathsAsARendererDoes) {
    const gltf::Scene scene = roomWithFence();
    const RenderSetup setup = defaultSetup(scene, 32, 18);
    const KnownRays known = knownRays(scene, setup, 3);
    const KnownRays first = knownRays(scene, setup, 1);
    ASSERT_GT(known.rays.size(), 50U);
    compiler::CompileSettings settings = stepSettings();
    settings.maxBounces = 3;
    settings.shadows = package::ShadowPlacement::Deferred;
    const LoadedScene loaded(scene, settings);
    Host host(loaded, known.rays, known.answers.size(), sizeof(RaySteps::Radiance));
    host.give(known.hits);
    for (const Way& way : ways()) {
        const bool isSorted = way.strategy == package::kStrategySortedUber;
        if (way.strategy == package::kStrategyVisibility && way.tracer == package::kTracerRayPipeline) {
            continue;  // the shading passes are those of ray queries
        }
        SCOPED_TRACE(std::string(nameOf(way.strategy)) + ", " + std::string(nameOf(way.tracer)));
        RaySteps::Options options;
        options.strategy = way.strategy;
        options.tracer = way.tracer;
        const auto steps = host.makeSteps(options);
        const auto answers = host.ask<RaySteps::Radiance>(*steps, setup.frame, {.givesHits = isSorted});
        EXPECT_EQ(countFar(known, answers, 1e-4F), 0U);
        const RaySteps::Counters counters = must(steps->counters());
        EXPECT_EQ(counters.rays, known.rays.size());
        EXPECT_GT(counters.furtherRays, known.rays.size() / 4);
        if (!counters.bucketCounts.empty()) {
            std::uint32_t hits = 0;
            for (const std::uint32_t count : counters.bucketCounts) {
                hits += count;
            }
            EXPECT_EQ(hits, counters.rays + counters.furtherRays);
        }
        if (isSorted) {
            host.changeLayout(*steps);
            EXPECT_EQ(countFar(known, host.ask<RaySteps::Radiance>(*steps, setup.frame, {}), 1e-4F), 0U);
        }
        if (way.strategy == package::kStrategyUber) {
            const auto direct = host.ask<RaySteps::Radiance>(*steps, setup.frame, {.bounces = 1});
            EXPECT_EQ(must(steps->counters()).furtherRays, 0U);
            EXPECT_GT(countFar(first, answers, 1e-4F), 0U);
            EXPECT_EQ(countFar(first, direct, 1e-4F), 0U);
            EXPECT_EQ(mustFail(steps->begin(VK_NULL_HANDLE, host.batchOf(setup.frame, {.bounces = 4}))).id,
                      "package-bounces");
        }
    }
}

// A room under the sky. Rays of a host bring all of the sky that they meet, those of a renderer's surfaces
// only the share that samples leave; all else is the same.
TEST(RaySteps, SampleTheSkyAsARendererDoes) {
    const gltf::Scene scene = roomWithFence();
    RenderSetup setup = defaultSetup(scene, 32, 18);
    LinearImage image{8, 4, std::vector<std::array<float, 4>>(32, {0.2F, 0.3F, 0.5F, 1.0F})};
    image.pixels[9] = {40.0F, 30.0F, 20.0F, 1.0F};
    const auto map = must(Environment::create(sharedContext(), image, {.sampled = true}));
    for (const std::uint32_t bounces : {1U, 3U}) {
        if (bounces > 1) {
            setup.frame.environment = map.get();
            setup.frame.environmentRotation = 0.7F;
            setup.frame.environmentIntensity = 0.5F;
        }
        const KnownRays chance = knownRays(scene, setup, bounces);
        KnownRays known = knownRays(scene, setup, bounces, compiler::SkyLight::On);
        ASSERT_GT(known.rays.size(), 50U);
        std::size_t misses = 0;
        for (const RaySteps::Ray& ray : known.rays) {
            RaySteps::Radiance& answer = known.answers[ray.slot];
            if (answer.path == 3.0F) {
                answer = chance.answers[ray.slot];
                ++misses;
            }
        }
        EXPECT_GT(misses, 0U);
        compiler::CompileSettings settings = stepSettings();
        settings.maxBounces = bounces;
        settings.skyLight = compiler::SkyLight::On;
        settings.environmentMap = bounces > 1;
        const LoadedScene loaded(scene, settings);
        ASSERT_TRUE(loaded.package().skyLight());
        Host host(loaded, known.rays, known.answers.size(), sizeof(RaySteps::Radiance));
        for (const Way& way : ways()) {
            if (way.strategy == package::kStrategyVisibility) {
                continue;
            }
            SCOPED_TRACE(std::string(nameOf(way.strategy)) + ", " + std::string(nameOf(way.tracer)));
            RaySteps::Options options;
            options.strategy = way.strategy;
            options.tracer = way.tracer;
            const auto steps = host.makeSteps(options);
            const auto answers = host.ask<RaySteps::Radiance>(*steps, setup.frame, {});
            EXPECT_EQ(countFar(known, answers, 1e-4F), 0U);
            EXPECT_GT(countFar(chance, answers, 1e-2F), known.rays.size() / 10)
                << "samples make a difference";
            if (bounces > 1) {
                FrameOptions frame = setup.frame;
                const auto unsampled = must(Environment::create(sharedContext(), image, {}));
                frame.environment = unsampled.get();
                EXPECT_EQ(mustFail(steps->begin(VK_NULL_HANDLE, host.batchOf(frame, {}))).id,
                          "environment-unsampled");
            }
        }
    }
}

// Steps that answer with surfaces send no shadow rays.
TEST(RaySteps, SurfacesAreNotLitByTheSky) {
    const gltf::Scene scene = emptyScene();
    compiler::CompileSettings settings = stepSettings();
    settings.skyLight = compiler::SkyLight::On;
    settings.answer = package::HitAnswer::Surface;
    EXPECT_EQ(mustFail(compiler::planPackage({&scene, 1}, settings)).id, "sky-light");
}

// A wall of a known material, and beside it an unlit one.
gltf::Scene wallAndLamp() {
    gltf::Scene scene = emptyScene();
    materials::Material paint;
    paint["baseColorFactor"] = {0.5F, 0.25F, 0.125F, 1.0F};
    paint["metallicFactor"] = 0.0F;
    paint["roughnessFactor"] = 0.5F;
    paint["emissiveFactor"] = {0.0F, 0.75F, 0.0F};
    addQuad(scene, paint, {-1, -1, -4}, {2, 0, 0}, {0, 2, 0});
    const materials::Material lamp = unlitMaterial({0.25F, 0.5F, 1.0F});
    addQuad(scene, lamp, {3, -1, -4}, {2, 0, 0}, {0, 2, 0});
    return scene;
}

// The wall is seen at an angle, and the sky beside it.
TEST(RaySteps, AnswerWithSurfaces) {
    const gltf::Scene scene = wallAndLamp();
    compiler::CompileSettings settings = stepSettings();
    settings.answer = package::HitAnswer::Surface;
    settings.plan.merge = compiler::MergePolicy::None;
    const LoadedScene loaded(scene, settings);
    const float tilt = 1.0F / std::sqrt(17.0F);
    const std::vector<RaySteps::Ray> rays{{{0.5F, 0.25F, 0.0F}, 2, {0.0F, 0.0F, -1.0F}, 0.0F, 0.0F},
                                          {{3.0F, 0.0F, 0.0F}, 0, {tilt, 0.0F, -4.0F * tilt}, 0.0F, 0.0F},
                                          {{0.0F, 0.0F, 0.0F}, 1, {0.0F, 1.0F, 0.0F}, 0.0F, 0.0F}};
    Host host(loaded, rays, 3, sizeof(RaySteps::Surface));
    for (const Way& way : ways()) {
        SCOPED_TRACE(std::string(nameOf(way.strategy)));
        RaySteps::Options options;
        options.strategy = way.strategy;
        options.tracer = way.tracer;
        const auto answers = host.answers<RaySteps::Surface>(options, {});
        ASSERT_EQ(answers.size(), 3U);
        const RaySteps::Surface& wall = answers[2];
        const auto expectVector = [](const std::array<float, 3>& v, const std::array<float, 3>& truth) {
            for (std::size_t i = 0; i < 3; ++i) {
                EXPECT_NEAR(v[i], truth[i], 1e-5F);
            }
        };
        expectVector(wall.position, {0.5F, 0.25F, -4.0F});
        expectVector(wall.normal, {0, 0, 1});
        expectVector(wall.geometricNormal, {0, 0, 1});
        expectVector(wall.albedo, {0.5F, 0.25F, 0.125F});
        expectVector(wall.f0, {0.04F, 0.04F, 0.04F});
        expectVector(wall.emission, {0, 0.75F, 0});
        expectVector(wall.motion, {0, 0, 0});
        EXPECT_NEAR(wall.roughness, 0.5F, 1e-6F);
        EXPECT_EQ(wall.f90, 1.0F);
        EXPECT_EQ(wall.material, 0U);
        EXPECT_LT(wall.shaderId, loaded.package().caseCount());
        EXPECT_GT(wall.clearance, 0.0F);
        expectVector(answers[0].position, {4.0F, 0.0F, -4.0F});
        expectVector(answers[0].emission, {0.25F, 0.5F, 1.0F});
        expectVector(answers[0].albedo, {0, 0, 0});
        EXPECT_NE(answers[0].shaderId, wall.shaderId);
        EXPECT_EQ(answers[0].material, 1U);
        EXPECT_EQ(answers[1].shaderId, RaySteps::Surface::kMiss);
        expectVector(answers[1].position, {0, 1, 0});
    }
}

// A host that keeps the vertices of the frame before, which here lay 0.25 m to the left and 0.5 m below.
TEST(RaySteps, PointsOfDeformingMeshesHaveMotionOfTheirOwn) {
    const auto own =
        std::ranges::find(compiler::builtinFiles(), "host/geometry.glsl", &base::BuiltinFile::name);
    ASSERT_NE(own, compiler::builtinFiles().end());
    const test::TemporaryFolder folder;
    const std::string text(own->text);
    ASSERT_TRUE(base::writeFile(folder.path() / "geometry.glsl",
                                text + "\n#define GLINT_HOST_PREVIOUS_POSITIONS\n"
                                       "vec3 hostPreviousPosition(HostGeometry geometry, uint vertex) {\n"
                                       "    return hostPosition(geometry, vertex) - vec3(0.25, 0.5, 0.0);\n"
                                       "}\n"));
    compiler::CompileSettings settings = stepSettings();
    settings.strategies = package::kStrategyUber;
    settings.answer = package::HitAnswer::Surface;
    settings.host = folder.path().string();
    const LoadedScene loaded(wallAndLamp(), settings);
    const std::vector<RaySteps::Ray> rays{{{0.5F, 0.25F, 0.0F}, 0, {0.0F, 0.0F, -1.0F}}};
    Host host(loaded, rays, 1, sizeof(RaySteps::Surface));
    RaySteps::Options options;
    options.strategy = package::kStrategyUber;
    const auto answers = host.answers<RaySteps::Surface>(options, {});
    ASSERT_EQ(answers.size(), 1U);
    EXPECT_NEAR(answers[0].motion[0], 0.25F, 1e-6F);
    EXPECT_NEAR(answers[0].motion[1], 0.5F, 1e-6F);
    EXPECT_NEAR(answers[0].motion[2], 0.0F, 1e-6F);
}

// Without a descriptor, and here without any descriptor set, the answers are those that a descriptor
// gives.
TEST(RaySteps, TakeAStructureByItsAddress) {
    const gltf::Scene scene = wallAndLamp();
    std::vector<RaySteps::Ray> rays;
    for (std::uint32_t slot = 0; slot < 64; ++slot) {
        const std::array<float, 3> to{-2.0F + 1.1F * static_cast<float>(slot % 8),
                                      -1.5F + 0.4F * static_cast<float>(slot / 8), -4.0F};
        const float length = std::hypot(to[0], to[1], to[2]);
        rays.push_back({{0, 0, 0}, slot, {to[0] / length, to[1] / length, to[2] / length}});
    }
    const LoadedScene described(scene, stepSettings());
    compiler::CompileSettings settings = stepSettings();
    settings.bindings.tlas = package::Bindings::kByAddress;
    const LoadedScene addressed(scene, settings);
    Host withSet(described, rays, rays.size(), sizeof(RaySteps::Radiance));
    Host without(addressed, rays, rays.size(), sizeof(RaySteps::Radiance));
    for (const Way& way : ways()) {
        // One way for each form of the shaders that trace: all ways trace by the same functions.
        const bool byQuery = way.tracer == package::kTracerRayQuery;
        if (way.strategy != (byQuery ? package::kStrategyUber : package::kStrategyVisibility) &&
            way.strategy != package::kStrategyHitShaders) {
            continue;
        }
        SCOPED_TRACE(std::string(nameOf(way.strategy)) + ", " + std::string(nameOf(way.tracer)));
        RaySteps::Options options;
        options.strategy = way.strategy;
        options.tracer = way.tracer;
        const auto truth = withSet.answers<RaySteps::Radiance>(options, {});
        const auto found = without.answers<RaySteps::Radiance>(options, {});
        ASSERT_EQ(found.size(), truth.size());
        std::array<std::size_t, 4> paths{};
        for (std::size_t i = 0; i < truth.size(); ++i) {
            EXPECT_EQ(found[i].path, truth[i].path) << i;
            ++paths.at(static_cast<std::size_t>(found[i].path));
            for (std::size_t channel = 0; channel < 3; ++channel) {
                EXPECT_NEAR(found[i].radiance[channel], truth[i].radiance[channel], 1e-6F) << i;
            }
        }
        // Both hits and misses are among them.
        EXPECT_GT(paths[2], 10U);
        EXPECT_GT(paths[3], 10U);
    }
    const auto shared = EngineScene::share(sharedContext(), addressed.gpuScene());
    RaySteps::Options options;
    options.strategy = package::kStrategyUber;
    options.maxRays = 1;
    options.layout = without.layout();
    options.pushStages = Host::kStages;
    const auto steps = must(RaySteps::create(sharedContext(), addressed.package(), **shared, options));
    RaySteps::Batch batch;
    batch.rays = batch.answers = 64;
    const Diagnostic refused = mustFail(steps->begin(VK_NULL_HANDLE, batch));
    EXPECT_NE(toString(refused).find("RaySteps::Batch::tlas is 0"), std::string::npos);
}

// A white wall, before it a tinted pane on the right, a mask that lets everything through above, and one that
// lets nothing through below.
gltf::Scene wallBehindPanes() {
    gltf::Scene scene = emptyScene();
    addQuad(scene, matte(0.5F), {-4, -4, -4}, {8, 0, 0}, {0, 8, 0});
    materials::Material glass = matte(0.0F);
    glass["baseColorFactor"] = {0.25F, 0.5F, 0.75F, 1.0F};
    glass["roughnessFactor"] = 0.0F;
    glass["transmissionFactor"] = 1.0F;
    glass["ior"] = 1.0F;
    addQuad(scene, glass, {1, -0.5F, -2}, {2, 0, 0}, {0, 1, 0});
    for (const float y : {1.0F, -2.0F}) {
        materials::Material mask = matte(0.5F);
        mask.alphaMode = materials::AlphaMode::Mask;
        mask["baseColorFactor"] = {0.5F, 0.5F, 0.5F, y > 0.0F ? 0.25F : 0.75F};
        addQuad(scene, mask, {-0.5F, y, -2}, {1, 0, 0}, {0, 1, 0});
    }
    return scene;
}

// Distances, both sides of a surface, alpha, and with --shadow-through glass the colour of glass, for
// packages with either answer.
TEST(RaySteps, AskForVisibility) {
    const auto ray = [](std::uint32_t slot, float x, float y, float distance, float from = 0.0F) {
        const float z = from < -1.0F ? 1.0F : -1.0F;
        return RaySteps::VisibilityRay{{x, y, from}, slot, {0, 0, z}, distance};
    };
    const std::vector<RaySteps::VisibilityRay> rays{ray(3, -2, 0, 3.9F),   ray(0, -2, 0, 4.1F),
                                                    ray(1, 2.3F, 0.1F, 3), ray(2, 0, 1.5F, 3),
                                                    ray(5, 0, -1.5F, 3),   ray(4, -2, 0, 9, -8)};
    const std::vector<float> shares{0, 0, 1, 1, 0, 0};  // by slot
    for (const auto through : {package::ShadowThrough::Alpha, package::ShadowThrough::Glass}) {
        const bool isGlass = through == package::ShadowThrough::Glass;
        compiler::CompileSettings settings = stepSettings();
        settings.shadowThrough = through;
        settings.answer = isGlass ? package::HitAnswer::Surface : package::HitAnswer::Radiance;
        const LoadedScene loaded(wallBehindPanes(), settings);
        ASSERT_EQ(loaded.package().shadowThrough(), through);
        Host host(loaded, rays, sizeof(std::array<float, 3>));
        for (const Way& way : ways()) {
            if (way.strategy != package::kStrategyUber && way.strategy != package::kStrategyHitShaders) {
                continue;  // the pass is that of uber
            }
            SCOPED_TRACE(std::string(nameOf(way.strategy)) + ", " + std::string(nameOf(way.tracer)));
            RaySteps::Options options;
            options.strategy = way.strategy;
            options.tracer = way.tracer;
            const auto steps = host.makeSteps(options);
            const Asked asked{.apart = true, .visibility = true};
            if (isGlass) {
                const auto found = host.ask<std::array<float, 3>>(*steps, {}, asked);
                for (std::size_t slot = 0; slot < shares.size(); ++slot) {
                    for (std::size_t channel = 0; channel < 3; ++channel) {
                        const float tint = 0.25F * static_cast<float>(channel + 1);
                        EXPECT_NEAR(found[slot][channel], slot == 1 ? tint : shares[slot], 1e-5F) << slot;
                    }
                }
            } else {
                EXPECT_EQ(host.ask<float>(*steps, {}, asked), shares);
            }
            EXPECT_EQ(must(steps->counters()).rays, rays.size());
        }
    }
}

// Rays that all go the same way.
std::vector<RaySteps::Ray> alike(std::uint32_t count, const std::array<float, 3>& origin) {
    std::vector<RaySteps::Ray> rays;
    for (std::uint32_t slot = 0; slot < count; ++slot) {
        rays.push_back({origin, slot, {0, 0, -1}});
    }
    return rays;
}

double meanRed(const std::vector<RaySteps::Radiance>& answers) {
    double sum = 0.0;
    for (const RaySteps::Radiance& answer : answers) {
        sum += static_cast<double>(answer.radiance[0]);
    }
    return sum / static_cast<double>(answers.size());
}

FrameOptions blackSky() {
    FrameOptions frame;
    frame.sky = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    return frame;
}

// The irradiance below the middle of a disk is intensity / (height² + radius²), on its front. A disk without
// a size lights a place to the side by the squares of its cosine.
TEST(RaySteps, ADiskLightsByLambertsLaw) {
    gltf::Scene scene = emptyScene();
    addQuad(scene, matte(0.5F), {-5, -5, -4}, {10, 0, 0}, {0, 10, 0});
    gltf::Light lamp;
    lamp.type = gltf::LightType::Point;
    lamp.intensity = 3.0F;
    lamp.position = {0, 0, -2};
    scene.lights.push_back(lamp);
    compiler::CompileSettings settings = stepSettings();
    settings.strategies = package::kStrategyUber;
    constexpr std::uint32_t kSlots = 2048;
    for (const auto& [radius, x, front] : {std::array{0.0F, 0.0F, -1.0F}, std::array{0.0F, 2.0F, -1.0F},
                                           std::array{1.5F, 0.0F, -1.0F}, std::array{1.5F, 0.0F, 1.0F}}) {
        const LoadedScene loaded(scene, settings, [&](session::SceneViewData& data) {
            LightView& light = data.lights.at(0);
            light.type = LightView::Type::Disk;
            light.direction = {0, 0, front};
            light.size = radius;
        });
        Host host(loaded, alike(kSlots, {x, 0, 0}), kSlots, sizeof(RaySteps::Radiance));
        RaySteps::Options options;
        options.strategy = package::kStrategyUber;
        const double mean = meanRed(host.answers<RaySteps::Radiance>(options, blackSky()));
        const double squared = 4.0 + static_cast<double>(x * x);
        const double facing = 4.0 / squared;
        const double irradiance = 3.0 * facing / (squared + static_cast<double>(radius * radius));
        const double expected = front < 0.0F ? 0.5 / 3.14159265 * irradiance : 0.0;
        EXPECT_NEAR(mean, expected, (radius > 0.0F ? 0.02 : 1e-4) * expected) << radius << ", " << x;
    }
}

// A square lamp that faces a wall lights the point below its middle by its form factor, whether samples alone
// or rays of paths find it, too. The host's own rays see all of its light.
TEST(RaySteps, AnEmissiveQuadLightsByItsFormFactor) {
    constexpr double kRadiance = 3.0;
    gltf::Scene scene = emptyScene();
    addQuad(scene, matte(0.5F), {-5, -5, -4}, {10, 0, 0}, {0, 10, 0});
    materials::Material lamp = matte(0.0F);
    lamp["emissiveFactor"] = {1.0F, 1.0F, 1.0F};
    lamp["emissiveStrength"] = static_cast<float>(kRadiance);
    addQuad(scene, lamp, {1, -1, -3}, {-2, 0, 0}, {0, 2, 0});
    // Half of the side over the height is 1.
    const double away = 1.0 / std::sqrt(2.0);
    const double factor = 4.0 / 3.14159265 * away * std::atan(away);
    constexpr std::uint32_t kSlots = 4096;
    for (const std::uint32_t bounces : {1U, 2U}) {
        compiler::CompileSettings settings = stepSettings();
        settings.strategies = package::kStrategyUber;
        settings.emissiveLights = compiler::EmissiveLights::On;
        settings.lightSamples = 1;
        settings.maxBounces = bounces;
        settings.shadows =
            bounces > 1 ? package::ShadowPlacement::Deferred : package::ShadowPlacement::Inline;
        const LoadedScene loaded(scene, settings, noLights);
        ASSERT_NE(loaded.package().emission(), nullptr);
        RaySteps::Options options;
        options.strategy = package::kStrategyUber;
        Host below(loaded, alike(kSlots, {0, 0, -3.5F}), kSlots, sizeof(RaySteps::Radiance));
        const double expected = 0.5 * kRadiance * factor;
        EXPECT_NEAR(meanRed(below.answers<RaySteps::Radiance>(options, blackSky())), expected,
                    0.03 * expected);
        std::vector<RaySteps::Ray> up = alike(8, {0, 0, -3.5F});
        for (RaySteps::Ray& ray : up) {
            ray.direction = {0, 0, 1};
        }
        Host seen(loaded, up, up.size(), sizeof(RaySteps::Radiance));
        EXPECT_NEAR(meanRed(seen.answers<RaySteps::Radiance>(options, blackSky())), kRadiance, 1e-4);
    }
}

// A mirror shows a sphere and a disk, whether all lights are looked for or those that a hierarchy leads to.
TEST(RaySteps, MirrorsShowSizedLights) {
    gltf::Scene scene = emptyScene();
    addQuad(scene, mirrorMaterial(), {-5, -5, -4}, {10, 0, 0}, {0, 10, 0});
    gltf::Light lamp;
    lamp.type = gltf::LightType::Point;
    lamp.intensity = 3.0F;
    for (const float x : {0.0F, 3.0F}) {
        lamp.position = {x, 0, -2};
        scene.lights.push_back(lamp);
    }
    constexpr float kRadius = 0.5F;
    const double expected = 3.0 / (3.14159265 * kRadius * kRadius);
    for (const bool finds : {false, true}) {
        for (const std::uint32_t lights : {0U, 1U}) {
            compiler::CompileSettings settings = stepSettings();
            settings.strategies = package::kStrategyUber;
            settings.maxBounces = 2;
            settings.lightSamples = lights;
            settings.sizedLights = finds ? compiler::SizedLights::On : compiler::SizedLights::Off;
            const LoadedScene loaded(scene, settings, [](session::SceneViewData& data) {
                data.lights.at(0).size = data.lights.at(1).size = kRadius;
                data.lights.at(1).type = LightView::Type::Disk;
                data.lights.at(1).direction = {0, 0, -1};
            });
            std::vector<RaySteps::Ray> rays = alike(2, {0, 0, -3});
            rays[1].origin[0] = 3.0F;
            Host host(loaded, rays, rays.size(), sizeof(RaySteps::Radiance));
            RaySteps::Options options;
            options.strategy = package::kStrategyUber;
            for (const RaySteps::Radiance& answer : host.answers<RaySteps::Radiance>(options, blackSky())) {
                EXPECT_NEAR(answer.radiance[0], finds ? expected : 0.0, 0.01 * expected) << lights;
            }
        }
    }
}

TEST(RaySteps, RefuseWhatTheyCannotDo) {
    const gltf::Scene scene = roomWithFence();
    compiler::CompileSettings frames;
    frames.strategies = package::kStrategyUber;
    frames.tracers = package::kAllTracers;
    const LoadedScene framePackage(scene, frames);
    compiler::CompileSettings settings = stepSettings();
    settings.strategies = package::kStrategyUber;
    const LoadedScene stepPackage(scene, settings);
    const auto shared = EngineScene::share(sharedContext(), stepPackage.gpuScene());
    ASSERT_TRUE(shared);
    RaySteps::Options options;
    options.strategy = package::kStrategyUber;
    options.maxRays = 16;
    const auto idOf = [](const auto& result) { return result ? std::string() : result.error().id; };
    EXPECT_EQ(idOf(RaySteps::create(sharedContext(), stepPackage.package(), **shared, options)), "ray-steps");
    EXPECT_EQ(idOf(RaySteps::create(sharedContext(), framePackage.package(), **shared, options)),
              "package-passes");
    RendererOptions renderer;
    renderer.strategy = package::kStrategyUber;
    EXPECT_EQ(
        idOf(Renderer::create(sharedContext(), stepPackage.package(), stepPackage.gpuScene(), renderer)),
        "package-passes");
    EXPECT_EQ(idOf((*shared)->update(VK_NULL_HANDLE, {}, {}, 0)), "engine-scene");
}

// A scene of a host's own is checked before anything is made of it.
TEST(EngineScene, NamesWhatIsWrong) {
    compiler::CompileSettings settings = stepSettings();
    settings.strategies = package::kStrategyUber;
    const LoadedScene loaded(roomWithFence(), settings);
    const PackageScene known = loaded.package().scene(0);
    const std::vector<std::array<float, 12>> instances{{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}};
    const std::vector<EngineScene::View::Texture> textures(known.textures.size(), {0, 4, 4});
    const std::vector<EngineScene::View::Sampler> samplers(known.samplers.size());
    const auto create = [&](const EngineScene::View::Geometry& geometry,
                            std::span<const EngineScene::View::Texture> images,
                            std::span<const std::uint32_t> firstRecords) {
        EngineScene::View view;
        view.geometries = {&geometry, 1};
        view.instances = instances;
        view.textures = images;
        view.samplers = samplers;
        view.firstRecords = firstRecords;
        const auto scene = EngineScene::create(sharedContext(), loaded.package(), view);
        return scene ? std::string() : toString(scene.error());
    };
    const package::PrimitiveEntry& entry = known.primitives.front();
    EngineScene::View::Geometry geometry{entry.mesh, entry.primitive, 0, 64, 64, 64, 64, 64, 64, 64};
    EXPECT_EQ(create(geometry, textures, {}), "");
    const std::uint32_t far[] = {5};
    EXPECT_NE(create(geometry, textures, far).find("entry 0 of firstRecords"), std::string::npos);
    EXPECT_NE(create(geometry, {}, {}).find("PackageScene::textures"), std::string::npos);
    geometry.instance = 3;
    EXPECT_NE(create(geometry, textures, {}).find("instance 3 is out of range"), std::string::npos);
    geometry.instance = 0;
    geometry.positions = 0;
    EXPECT_NE(create(geometry, textures, {}).find("reads positions"), std::string::npos);
    geometry.mesh = 10000;
    EXPECT_NE(create(geometry, textures, {}).find("mesh 10000"), std::string::npos);
}

}  // namespace
