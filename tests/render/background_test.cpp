// Frames that are drawn while pipelines are still being made, and with materials that no shader is for.
#include "context/upload.h"
#include "render/hall.h"
#include "render/harness.h"
#include "render/light_pictures.h"
#include "renderer/renderer.h"
#include "scene/scene_store.h"
#include "support/must.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <string>
#include <vector>

namespace {

using namespace glint;
using namespace glint::testing;

compiler::CompileSettings settingsWith(bool fallback) {
    compiler::CompileSettings settings;
    settings.strategies = package::allStrategies();
    settings.tracers = package::kAllTracers;
    settings.plan.merge = compiler::MergePolicy::None;
    settings.plan.keys.alpha = package::AlphaPolicy::Tested;
    settings.plan.fallback = fallback;
    return settings;
}

RendererOptions optionsOf(const RenderSetup& setup, package::Strategy strategy, package::Tracer tracer) {
    RendererOptions options;
    options.width = setup.width;
    options.height = setup.height;
    options.strategy = strategy;
    options.tracer = tracer;
    return options;
}

LinearImage renderedBy(Renderer& renderer, const RenderSetup& setup) {
    return must(renderer.render(setup.frame, setup.samples));
}

// Calls `test` with every strategy and tracer that the device has.
template <typename Test>
void forEachWay(const Test& test) {
    for (const package::Strategy strategy : package::strategies()) {
        for (const package::Tracer tracer : package::kTracers) {
            const bool has = (sharedContext().handles().tracers & tracer) != 0;
            if (has && (package::tracersOf(strategy, package::kAllTracers) & tracer) != 0) {
                test(
                    strategy, tracer,
                    std::string(package::nameOf(strategy)) + " with " + std::string(package::nameOf(tracer)));
            }
        }
    }
}

// Returns the frame for a mean of that many samples, of which only some are rendered.
FrameOptions withCones(FrameOptions frame, std::uint32_t samples) {
    frame.averagedSamples = samples;
    return frame;
}

void expectDraft(Renderer& renderer, std::uint64_t drafts, const std::string& name) {
    const Renderer::PipelineProgress progress = renderer.pipelineProgress();
    EXPECT_TRUE(progress.draft) << name;
    EXPECT_EQ(progress.drafts, drafts) << name;
    const Result<Renderer::Counters> counters = renderer.counters();
    ASSERT_TRUE(counters) << name;
    EXPECT_TRUE(counters->draft) << name;
    EXPECT_EQ(counters->rays, 0U) << name;
}

// A draft shows the scene, finite and about as bright, and is another picture.
void expectLikeness(const LinearImage& draft, const LinearImage& reference, const std::string& name) {
    ASSERT_EQ(draft.pixels.size(), reference.pixels.size()) << name;
    EXPECT_TRUE(std::isfinite(meanOf(draft))) << name;
    EXPECT_GT(meanOf(draft), 0.5 * meanOf(reference)) << name;
    EXPECT_LT(meanOf(draft), 2.0 * meanOf(reference)) << name;
    double product = 0.0;
    double squares[2] = {};
    double most = 0.0;
    const double means[] = {meanOf(draft), meanOf(reference)};
    for (std::size_t i = 0; i < draft.pixels.size(); ++i) {
        const double a = draft.pixels[i][1] - means[0];
        const double b = reference.pixels[i][1] - means[1];
        product += a * b;
        squares[0] += a * a;
        squares[1] += b * b;
        most = std::max(most, std::abs(static_cast<double>(draft.pixels[i][1] - reference.pixels[i][1])));
    }
    EXPECT_GT(product / std::sqrt(squares[0] * squares[1]), 0.5) << name;
    EXPECT_GT(most, 0.01) << name;
}

// The scene of these tests, compiled once.
class Background : public ::testing::Test {
protected:
    static void SetUpTestSuite() {
        scene_ = new gltf::Scene(hallScene());
        loaded_ = new LoadedScene(*scene_, settingsWith(true));
    }
    static void TearDownTestSuite() {
        delete loaded_;
        delete scene_;
    }
    void SetUp() override {
        setup_ = defaultSetup(*scene_, 32, 18);
    }

    static inline gltf::Scene* scene_ = nullptr;
    static inline LoadedScene* loaded_ = nullptr;
    RenderSetup setup_;
};

TEST_F(Background, EveryStateOnTheWayGivesTheSamePicture) {
    forEachWay([&](package::Strategy strategy, package::Tracer tracer, const std::string& name) {
        RendererOptions options = optionsOf(setup_, strategy, tracer);
        const LinearImage reference = loaded_->render(options, setup_);
        options.backgroundPipelines = true;
        const auto renderer = loaded_->makeRenderer(options);
        std::size_t& adoptedAtOnce = renderer->state().pipelines.adoptedAtOnce;
        adoptedAtOnce = 0;
        const LinearImage draft = renderedBy(*renderer, setup_);
        expectDraft(*renderer, setup_.samples, name);
        expectLikeness(draft, reference, name + ", draft");
        renderer->waitForPipelines();
        adoptedAtOnce = 1;
        expectSameImage(renderedBy(*renderer, setup_), reference, name + ", fallback alone");
        Renderer::PipelineProgress progress = renderer->pipelineProgress();
        EXPECT_FALSE(progress.draft) << name;
        EXPECT_EQ(progress.drafts, setup_.samples) << name;
        for (std::uint32_t state = 0; progress.adopted < progress.wanted && state < progress.wanted;
             ++state) {
            expectSameImage(renderedBy(*renderer, setup_), reference,
                            name + ", " + std::to_string(progress.adopted) + " pipelines");
            progress = renderer->pipelineProgress();
            EXPECT_FALSE(progress.error) << name;
        }
        EXPECT_EQ(progress.adopted, progress.wanted) << name;
        const Renderer::Counters counters = must(renderer->counters());
        EXPECT_EQ(counters.unknownShader, 0U) << name;
        EXPECT_FALSE(counters.draft) << name;
    });
}

TEST_F(Background, AHostMayAskForNoDraft) {
    const bool queries = (sharedContext().handles().tracers & package::kTracerRayQuery) != 0;
    RendererOptions options = optionsOf(setup_, package::kStrategyVisibility,
                                        queries ? package::kTracerRayQuery : package::kTracerRayPipeline);
    const LinearImage reference = loaded_->render(options, setup_);
    options.backgroundPipelines = true;
    options.draft = false;
    const auto renderer = loaded_->makeRenderer(options);
    renderer->state().pipelines.adoptedAtOnce = 0;
    expectSameImage(renderedBy(*renderer, setup_), reference, "fallback alone");
    const Renderer::PipelineProgress progress = renderer->pipelineProgress();
    EXPECT_FALSE(progress.draft);
    EXPECT_EQ(progress.drafts, 0U);
    // Each case has a pipeline for first hits and one for hits of rays.
    EXPECT_EQ(progress.wanted, 2 * loaded_->package().caseCount());
}

// A mean of samples that began with drafts has none of them once these end.
TEST_F(Background, DraftsAreInNoMean) {
    const bool queries = (sharedContext().handles().tracers & package::kTracerRayQuery) != 0;
    RendererOptions options = optionsOf(setup_, package::kStrategyUber,
                                        queries ? package::kTracerRayQuery : package::kTracerRayPipeline);
    options.backgroundPipelines = true;
    const auto drafting = loaded_->makeRenderer(options);
    options.draft = false;
    const auto other = loaded_->makeRenderer(options);
    ASSERT_TRUE(drafting && other);
    std::size_t& adoptedAtOnce = drafting->state().pipelines.adoptedAtOnce;
    adoptedAtOnce = 0;
    other->state().pipelines.adoptedAtOnce = 0;
    drafting->waitForPipelines();
    // The drafts end with the third sample; the picture is the mean of the third and the fourth.
    std::uint32_t sample = 0;
    const LinearImage image = must(drafting->render(setup_.frame, 4, [&] {
        adoptedAtOnce = ++sample == 2 ? 1 : 0;
        return okStatus();
    }));
    EXPECT_EQ(drafting->pipelineProgress().drafts, 2U);
    // The third and the fourth sample are what four samples have beyond two.
    const Result<LinearImage> two = other->render(withCones(setup_.frame, 4), 2);
    const Result<LinearImage> four = other->render(setup_.frame, 4);
    ASSERT_TRUE(two && four);
    LinearImage wanted = *four;
    for (std::size_t i = 0; i < wanted.pixels.size(); ++i) {
        for (std::size_t channel = 0; channel < 3; ++channel) {
            wanted.pixels[i][channel] = 2.0F * four->pixels[i][channel] - two->pixels[i][channel];
        }
    }
    expectSameImage(image, wanted, "the third and the fourth sample");
}

// Frames in bands, and paths whose depth decides what later frames record.
TEST_F(Background, PathsInBandsBeginWithADraft) {
    const bool queries = (sharedContext().handles().tracers & package::kTracerRayQuery) != 0;
    compiler::CompileSettings settings = settingsWith(true);
    settings.strategies = package::kStrategyUber;
    settings.tracers = queries ? package::kTracerRayQuery : package::kTracerRayPipeline;
    settings.maxBounces = 12;
    settings.emissiveLights = compiler::EmissiveLights::On;
    const LoadedScene loaded(*scene_, settings);
    RendererOptions options = optionsOf(setup_, package::kStrategyUber,
                                        queries ? package::kTracerRayQuery : package::kTracerRayPipeline);
    options.bounces = settings.maxBounces;
    options.bands = 2;
    RenderSetup setup = setup_;
    setup.frame.recordAllBounces = true;
    const LinearImage reference = loaded.render(options, setup);
    options.backgroundPipelines = true;
    const auto renderer = loaded.makeRenderer(options);
    std::size_t& adoptedAtOnce = renderer->state().pipelines.adoptedAtOnce;
    adoptedAtOnce = 0;
    const LinearImage draft = renderedBy(*renderer, setup);
    expectDraft(*renderer, setup.samples, "paths");
    expectLikeness(draft, reference, "paths");
    renderer->waitForPipelines();
    adoptedAtOnce = 1;
    expectSameImage(renderedBy(*renderer, setup), reference, "without a draft");
}

// The pipelines are in the shader cache by now, so a picture that differs shows a pipeline in a wrong place.
TEST_F(Background, FramesFollowEachOtherWhileThreadsWork) {
    RendererOptions options = optionsOf(setup_, package::kStrategyVisibility, package::kTracerRayQuery);
    if ((sharedContext().handles().tracers & package::kTracerRayQuery) == 0) {
        GTEST_SKIP() << "the device has no ray queries";
    }
    const LinearImage reference = loaded_->render(options, setup_);
    options.backgroundPipelines = true;
    options.pipelineThreads = 2;
    const auto renderer = loaded_->makeRenderer(options);
    Renderer::PipelineProgress progress = renderer->pipelineProgress();
    for (int frame = 0; frame < 1000 && progress.adopted < progress.wanted; ++frame) {
        const LinearImage image = renderedBy(*renderer, setup_);
        const Renderer::Counters counters = must(renderer->counters());
        if (!counters.draft) {
            expectSameImage(image, reference, "frame " + std::to_string(frame));
        }
        progress = renderer->pipelineProgress();
    }
    EXPECT_EQ(progress.adopted, progress.wanted);
    // A renderer may go while its threads work.
    EXPECT_NE(loaded_->makeRenderer(options), nullptr);
}

// Gives every geometry a shader ID that no case has.
void forgetCases(GpuScene::State& scene) {
    MemoryPool pool(sharedContext().state());
    Uploader uploader(sharedContext().state(), pool);
    constexpr std::uint32_t kUnknown = 77;
    std::vector<std::uint8_t> bytes(sizeof kUnknown);
    std::memcpy(bytes.data(), &kUnknown, sizeof kUnknown);
    for (std::size_t i = 0; i < scene.shaderIds.size(); ++i) {
        const std::size_t place = i * sizeof(gpu::GeometryRecord) + offsetof(gpu::GeometryRecord, shaderId);
        ASSERT_TRUE(uploader.copyToBuffer(bytes, scene.store->geometries.device, place));
        scene.shaderIds[i] = kUnknown;
    }
    ASSERT_TRUE(uploader.finish());
}

TEST_F(Background, TheFallbackShadesUnknownShaderIds) {
    const LoadedScene unknown(*scene_, settingsWith(true));
    forgetCases(unknown.gpuScene().state());
    forEachWay([&](package::Strategy strategy, package::Tracer tracer, const std::string& name) {
        const RendererOptions options = optionsOf(setup_, strategy, tracer);
        const LinearImage reference = loaded_->render(options, setup_);
        Renderer::Counters counters;
        expectSameImage(unknown.render(options, setup_, &counters), reference, name);
    });
}

TEST_F(Background, NeedsAPackageWithAFallback) {
    const LoadedScene without(*scene_, settingsWith(false));
    RendererOptions options = optionsOf(setup_, package::kStrategyUber, package::kTracerRayQuery);
    options.backgroundPipelines = true;
    EXPECT_EQ(mustFail(Renderer::create(sharedContext(), without.package(), without.gpuScene(), options)).id,
              "package-fallback");
    EXPECT_TRUE(
        without.package().spirv({package::roleNamed("ShadeFallback"), 0, package::kTracerRayQuery}).empty());
}

}  // namespace
