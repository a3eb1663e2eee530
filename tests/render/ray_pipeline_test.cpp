// Tests ray tracing pipelines: every strategy gives the same picture with every tracer, and so does a device
// without ray queries.
#include "context/context.h"
#include "render/hall.h"
#include "render/pixel_test.h"
#include "render/ways.h"
#include "scene/gpu_scene_state.h"
#include "support/must.h"

#include <glint/internal/package_modules.h>
#include <glint/session/scene_view.h>

#include <optional>
#include <string>
#include <vector>

namespace {

using namespace glint;
using namespace glint::testing;

using package::ShadowPlacement;
using package::Strategy;
using package::Tracer;

compiler::CompileSettings settingsFor(ShadowPlacement shadows, compiler::MergePolicy merge) {
    compiler::CompileSettings settings;
    settings.strategies = package::allStrategies();
    settings.tracers = package::kAllTracers;
    settings.shadows = shadows;
    settings.plan.merge = merge;
    settings.plan.keys.alpha = package::AlphaPolicy::Tested;
    return settings;
}

// Every surface sends a ray.
RenderSetup hallSetup(const gltf::Scene& scene) {
    RenderSetup setup = defaultSetup(scene, 48, 36);
    setup.samples = 2;
    setup.frame.maxReflectionRoughness = 1.0F;
    return setup;
}

// Adds a mirror in front of the camera, across its view.
void addMirror(gltf::Scene& scene) {
    const int mirror = addMaterial(scene, mirrorMaterial());
    addQuad(scene, mirror, {-1, -1, -1}, {2, 0, 0}, {0, 2, 0});
}

bool deviceHas(Tracer tracer) {
    return (sharedContext().handles().tracers & tracer) != 0;
}

class DeviceWithPipelines : public ::testing::Test {
protected:
    void SetUp() override {
        if (!deviceHas(package::kTracerRayPipeline)) {
            GTEST_SKIP() << "the device has no ray tracing pipelines";
        }
    }
};

// Renders every way that the settings and the device allow.
void expectAllWaysAgree(const gltf::Scene& scene, const compiler::CompileSettings& settings,
                        const RenderSetup& setup, Renderer::Counters& counters) {
    const LoadedScene loaded(scene, settings);
    std::optional<LinearImage> reference;
    for (const Way& way : waysOf(settings.strategies, settings.tracers)) {
        SCOPED_TRACE(nameOf(way));
        Renderer::Counters counted;
        const LinearImage image = loaded.render(optionsOf(way), setup, &counted);
        if (!reference) {
            reference = image;
            counters = counted;
        }
        expectSameImage(image, *reference, nameOf(way));
        EXPECT_EQ(counted.rays, counters.rays);
        EXPECT_EQ(counted.shadowRays, counters.shadowRays);
    }
}

Renderer::Counters expectAllWaysAgreeInHall(const compiler::CompileSettings& settings) {
    const gltf::Scene scene = hallScene();
    Renderer::Counters counters;
    expectAllWaysAgree(scene, settings, hallSetup(scene), counters);
    EXPECT_GT(counters.rays, 900U);
    return counters;
}

TEST(RayPipelines, EveryStrategyAndTracerGivesTheSamePicture) {
    const Renderer::Counters counters =
        expectAllWaysAgreeInHall(settingsFor(ShadowPlacement::Inline, compiler::MergePolicy::None));
    EXPECT_EQ(counters.shadowRays, 0U);
}

TEST(RayPipelines, DeferredShadowsAndSharedCasesToo) {
    const Renderer::Counters counters =
        expectAllWaysAgreeInHall(settingsFor(ShadowPlacement::Deferred, compiler::MergePolicy::All));
    EXPECT_GT(counters.shadowRays, 100U);
}

TEST(RayPipelines, PackedHitsToo) {
    compiler::CompileSettings settings = settingsFor(ShadowPlacement::Inline, compiler::MergePolicy::Family);
    settings.hitRecord = package::HitRecordFormat::Packed;
    settings.strategies = package::orderedStrategies();
    expectAllWaysAgreeInHall(settings);
}

TEST(RayPipelines, ShadersThatAreNotOptimisedToo) {
    compiler::CompileSettings settings = settingsFor(ShadowPlacement::Inline, compiler::MergePolicy::Family);
    settings.optimize = false;
    settings.strategies = package::kStrategyUber | package::kStrategyHitShaders;
    expectAllWaysAgreeInHall(settings);
}

// First no surface, so that lists have no elements; then one whose rays all leave the scene.
TEST(RayPipelines, ListsWithoutElementsAndRaysWithoutHits) {
    gltf::Scene scene = sceneWithCamera();
    const compiler::CompileSettings settings =
        settingsFor(ShadowPlacement::Deferred, compiler::MergePolicy::None);
    Renderer::Counters counters;
    expectAllWaysAgree(scene, settings, squareSetup(scene), counters);
    EXPECT_EQ(counters.rays, 0U);
    addMirror(scene);
    expectAllWaysAgree(scene, settings, squareSetup(scene), counters);
    EXPECT_EQ(counters.rays, 32U * 32U);
    EXPECT_EQ(counters.shadowRays, 0U);
}

TEST_F(DeviceWithPipelines, LetsLightAndRaysThroughMasks) {
    const gltf::Scene scene = hallScene();
    compiler::CompileSettings settings = settingsFor(ShadowPlacement::Inline, compiler::MergePolicy::None);
    settings.strategies = package::kStrategyHitShaders;
    const LoadedScene tested(scene, settings);
    settings.plan.keys.alpha = package::AlphaPolicy::Opaque;
    const LoadedScene opaque(scene, settings);
    const RenderSetup setup = hallSetup(scene);
    const LinearImage withHoles = tested.render(package::kStrategyHitShaders, setup);
    const LinearImage without = opaque.render(package::kStrategyHitShaders, setup);
    EXPECT_NE(withHoles.pixels, without.pixels);
}

// A mirror sees a wall whose shader ID no case has.
TEST_F(DeviceWithPipelines, ShowsUnknownShadersInMagenta) {
    gltf::Scene scene = sceneWithCamera();
    addMirror(scene);
    const int red = addMaterial(scene, unlitMaterial(kRed));
    addQuad(scene, red, {9, -9, 3}, {-18, 0, 0}, {0, 18, 0});
    const LoadedScene loaded(scene, settingsFor(ShadowPlacement::Inline, compiler::MergePolicy::None));
    const RenderSetup setup = squareSetup(scene);
    expectColor(at(loaded.render(package::kStrategyHitShaders, setup), 16, 16), kRed, 1e-4F, "known");

    loaded.gpuScene().state().shaderIds.back() = 77;
    RendererOptions options = optionsOf({package::kStrategyHitShaders, package::kTracerRayPipeline});
    options.width = setup.width;
    options.height = setup.height;
    const auto renderer = loaded.makeRenderer(options);
    const LinearImage image = must(renderer->render(setup.frame));
    expectColor(at(image, 16, 16), {1.0F, 0.0F, 1.0F}, 1e-4F, "unknown");
    const Renderer::Counters counters = must(renderer->counters());
    EXPECT_EQ(counters.unknownShader, 32U * 32U);
}

TEST_F(DeviceWithPipelines, RefusesImagesAboveOneDispatch) {
    gltf::Scene scene = sceneWithCamera();
    compiler::CompileSettings settings = settingsFor(ShadowPlacement::Inline, compiler::MergePolicy::None);
    settings.strategies = package::kStrategyHitShaders;
    const LoadedScene loaded(scene, settings);
    std::uint32_t& limit = sharedContext().state().limits.rayPipeline.maxRayDispatchInvocationCount;
    const std::uint32_t before = limit;
    RendererOptions options = optionsOf({package::kStrategyHitShaders, package::kTracerRayPipeline});
    options.width = options.height = 32;
    limit = 32 * 32;
    const auto made = Renderer::create(sharedContext(), loaded.package(), loaded.gpuScene(), options);
    limit = 32 * 32 - 1;
    const auto refused = Renderer::create(sharedContext(), loaded.package(), loaded.gpuScene(), options);
    limit = before;
    EXPECT_TRUE(made);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().id, "render-size");
}

// A device with only one of the tracers renders the same picture as one with the other. A package for the
// other tracer is refused.
class OneTracer : public ::testing::TestWithParam<Tracer> {
protected:
    void SetUp() override {
        if (!deviceHas(GetParam())) {
            GTEST_SKIP() << "the device lacks this tracer";
        }
    }
};

TEST_P(OneTracer, IsEnoughForEveryStrategyThatItHas) {
    HeadlessOptions headless;
    headless.validation = Validation::Synchronization;
    headless.tracers = GetParam();
    const auto context = must(Context::createHeadless(headless));
    EXPECT_EQ(context->handles().tracers, GetParam());

    const gltf::Scene scene = hallScene();
    const LoadedScene loaded(scene, settingsFor(ShadowPlacement::Inline, compiler::MergePolicy::All));
    const RenderSetup setup = hallSetup(scene);
    const LinearImage reference = loaded.render(package::kStrategyVisibility, setup);
    const session::SceneViewData view = session::makeSceneView(scene);
    auto uploaded = must(GpuScene::upload(*context, loaded.package(), view.view()));
    for (const Way& way : waysOf(package::allStrategies(), package::kAllTracers)) {
        SCOPED_TRACE(nameOf(way));
        RendererOptions options = optionsOf(way);
        options.width = setup.width;
        options.height = setup.height;
        auto renderer = Renderer::create(*context, loaded.package(), *uploaded, options);
        if (way.tracer != GetParam()) {
            ASSERT_FALSE(renderer);
            EXPECT_EQ(renderer.error().id, "device-tracer");
            continue;
        }
        ASSERT_TRUE(renderer) << toString(renderer.error());
        const LinearImage image = must((*renderer)->render(setup.frame, setup.samples));
        expectSameImage(image, reference, nameOf(way));
    }
    for (const std::string& message : context->validationMessages()) {
        ADD_FAILURE() << message;
    }
}

INSTANTIATE_TEST_SUITE_P(Tracers, OneTracer, ::testing::ValuesIn(package::kTracers),
                         [](const ::testing::TestParamInfo<Tracer>& tracer) {
                             return tracer.param == package::kTracerRayQuery ? "RayQuery" : "RayPipeline";
                         });

}  // namespace
