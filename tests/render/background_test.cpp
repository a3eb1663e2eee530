// Frames that are drawn while pipelines are still being made, and with materials that no shader is for.
#include "context/upload.h"
#include "render/hall.h"
#include "render/harness.h"
#include "renderer/renderer_state.h"

#include <gtest/gtest.h>

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
    const Result<LinearImage> image = renderer.render(setup.frame, setup.samples);
    EXPECT_TRUE(image) << toString(image.error());
    return image ? *image : LinearImage{};
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
        ASSERT_TRUE(loaded_->ok());
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
        auto renderer = Renderer::create(sharedContext(), loaded_->package(), loaded_->gpuScene(), options);
        ASSERT_TRUE(renderer) << name << ": " << toString(renderer.error());
        std::size_t& adoptedAtOnce = (*renderer)->state().pipelines.adoptedAtOnce;
        adoptedAtOnce = 0;
        expectSameImage(renderedBy(**renderer, setup_), reference, name + ", fallback alone");
        (*renderer)->waitForPipelines();
        const std::uint32_t wanted = (*renderer)->pipelineProgress().wanted;
        const bool ofCases = strategy == package::kStrategyVisibility;
        EXPECT_EQ(wanted, ofCases ? loaded_->package().caseCount() : 1U) << name;
        adoptedAtOnce = 1;
        for (std::uint32_t adopted = 1; adopted <= wanted; ++adopted) {
            expectSameImage(renderedBy(**renderer, setup_), reference,
                            name + ", " + std::to_string(adopted) + " pipelines");
            const PipelineProgress progress = (*renderer)->pipelineProgress();
            EXPECT_EQ(progress.adopted, adopted) << name;
            EXPECT_EQ(progress.made, wanted) << name;
            EXPECT_FALSE(progress.error) << name;
        }
        const Result<FrameCounters> counters = (*renderer)->counters();
        ASSERT_TRUE(counters);
        EXPECT_EQ(counters->unknownShader, 0U) << name;
        expectNoValidationMessages();
    });
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
    auto renderer = Renderer::create(sharedContext(), loaded_->package(), loaded_->gpuScene(), options);
    ASSERT_TRUE(renderer) << toString(renderer.error());
    PipelineProgress progress = (*renderer)->pipelineProgress();
    for (int frame = 0; frame < 1000 && progress.adopted < progress.wanted; ++frame) {
        expectSameImage(renderedBy(**renderer, setup_), reference, "frame " + std::to_string(frame));
        progress = (*renderer)->pipelineProgress();
    }
    EXPECT_EQ(progress.adopted, progress.wanted);
    // A renderer may go while its threads work.
    renderer = Renderer::create(sharedContext(), loaded_->package(), loaded_->gpuScene(), options);
    ASSERT_TRUE(renderer) << toString(renderer.error());
    renderer->reset();
    expectNoValidationMessages();
}

// Gives every geometry a shader ID that no case has.
void forgetCases(GpuScene::State& scene) {
    Result<std::unique_ptr<Uploader>> uploader = Uploader::create(sharedContext().state());
    ASSERT_TRUE(uploader);
    constexpr std::uint32_t kUnknown = 77;
    std::vector<std::uint8_t> bytes(sizeof kUnknown);
    std::memcpy(bytes.data(), &kUnknown, sizeof kUnknown);
    for (std::size_t i = 0; i < scene.shaderIds.size(); ++i) {
        const std::size_t place = i * sizeof(gpu::GeometryRecord) + offsetof(gpu::GeometryRecord, shaderId);
        ASSERT_TRUE((*uploader)->copyToBuffer(bytes, scene.geometries, place));
        scene.shaderIds[i] = kUnknown;
    }
    ASSERT_TRUE((*uploader)->finish());
}

TEST_F(Background, TheFallbackShadesUnknownShaderIds) {
    const LoadedScene unknown(*scene_, settingsWith(true));
    ASSERT_TRUE(unknown.ok());
    forgetCases(unknown.gpuScene().state());
    forEachWay([&](package::Strategy strategy, package::Tracer tracer, const std::string& name) {
        const RendererOptions options = optionsOf(setup_, strategy, tracer);
        const LinearImage reference = loaded_->render(options, setup_);
        FrameCounters counters;
        expectSameImage(unknown.render(options, setup_, &counters), reference, name);
    });
}

TEST_F(Background, NeedsAPackageWithAFallback) {
    const LoadedScene without(*scene_, settingsWith(false));
    ASSERT_TRUE(without.ok());
    RendererOptions options = optionsOf(setup_, package::kStrategyUber, package::kTracerRayQuery);
    options.backgroundPipelines = true;
    const auto renderer = Renderer::create(sharedContext(), without.package(), without.gpuScene(), options);
    ASSERT_FALSE(renderer);
    EXPECT_EQ(renderer.error().id, "package-fallback");
    EXPECT_TRUE(
        without.package().spirv({package::roleNamed("ShadeFallback"), 0, package::kTracerRayQuery}).empty());
}

}  // namespace
