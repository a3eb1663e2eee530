#include "render/harness.h"

#include "image/compare.h"
#include "support/shared_modules.h"

#include <glint/scene_view/camera.h>
#include <glint/scene_view/package.h>
#include <glint/scene_view/scene_view.h>

#include <cmath>
#include <cstdlib>

namespace glint::testing {

Context& sharedContext() {
    static const std::unique_ptr<Context> context = [] {
        HeadlessOptions options;
        // For machines that have a driver and no layers.
        const bool unvalidated = std::getenv("GLINT_TESTS_UNVALIDATED") != nullptr;
        options.validation = unvalidated ? Validation::Off : Validation::Synchronization;
        options.shaderFloat16 = true;
        Result<std::unique_ptr<Context>> made = Context::createHeadless(options);
        if (!made) {
            ADD_FAILURE() << toString(made.error());
            std::abort();
        }
        return std::move(*made);
    }();
    return *context;
}

void expectNoValidationMessages() {
    static std::size_t reported = 0;
    const std::vector<std::string> messages = sharedContext().validationMessages();
    for (; reported < messages.size(); ++reported) {
        ADD_FAILURE() << messages[reported];
    }
}

LoadedScene::LoadedScene(const gltf::Scene& scene, const compiler::PlanOptions& plan)
    : LoadedScene(scene, compiler::CompileSettings{.plan = plan}) {}

LoadedScene::LoadedScene(const gltf::Scene& scene, const compiler::CompileSettings& settings,
                         const std::function<void(scene_view::SceneViewData&)>& change) {
    const Status loaded = load(scene, settings, change);
    if (!loaded) {
        ADD_FAILURE() << toString(loaded.error());
    }
}

Status LoadedScene::load(const gltf::Scene& scene, const compiler::CompileSettings& settings,
                         const std::function<void(scene_view::SceneViewData&)>& change) {
    Result<compiler::CompiledPackage> compiled = compilePackage(scene, settings, &sharedModules());
    if (!compiled) {
        return compiled.error();
    }
    compiled_ = std::move(*compiled);
    Result<Package> package = scene_view::loadPackage(compiled_);
    if (!package) {
        return package.error();
    }
    package_ = std::make_unique<Package>(std::move(*package));

    scene_view::SceneViewData data = scene_view::makeSceneView(scene);
    data.vertices = VertexForm::Full;  // pictures are compared with exact ones
    if (scene.lights.empty()) {
        data.lights.push_back(scene_view::sunLight());
    }
    if (change) {
        change(data);
    }
    scene_view::useLayoutOf(*package_, scene, data);
    Result<std::unique_ptr<GpuScene>> uploaded = GpuScene::upload(sharedContext(), *package_, data.view());
    if (!uploaded) {
        return uploaded.error();
    }
    gpuScene_ = std::move(*uploaded);
    return okStatus();
}

LoadedScene::~LoadedScene() = default;

LinearImage LoadedScene::render(package::Strategy strategy, const RenderSetup& setup,
                                FrameCounters* counters) const {
    return render(RendererOptions{.strategy = strategy}, setup, counters);
}

LinearImage LoadedScene::render(RendererOptions options, const RenderSetup& setup,
                                FrameCounters* counters) const {
    options.width = setup.width;
    options.height = setup.height;
    options.countsLight = options.countsLight || setup.countsLight;
    Result<std::unique_ptr<Renderer>> renderer =
        Renderer::create(sharedContext(), *package_, *gpuScene_, options);
    if (!renderer) {
        ADD_FAILURE() << toString(renderer.error());
        return {};
    }
    Result<LinearImage> image = (*renderer)->render(setup.frame, setup.samples);
    if (!image) {
        ADD_FAILURE() << toString(image.error());
        return {};
    }
    if (counters != nullptr) {
        Result<FrameCounters> counted = (*renderer)->counters();
        if (!counted) {
            ADD_FAILURE() << toString(counted.error());
            return {};
        }
        *counters = *counted;
        EXPECT_EQ(counters->unknownShader, 0U);
    }
    expectNoValidationMessages();
    return std::move(*image);
}

RenderSetup defaultSetup(const gltf::Scene& scene, std::uint32_t width, std::uint32_t height) {
    RenderSetup setup;
    setup.width = width;
    setup.height = height;
    const scene_view::SceneViewData data = scene_view::makeSceneView(scene);
    const double aspect = static_cast<double>(width) / height;
    const Result<scene_view::CameraChoice> camera = scene_view::chooseCamera(scene, data, "", aspect);
    setup.frame.camera =
        camera ? camera->view : scene_view::framingCamera(scene_view::worldBounds(data), aspect);
    return setup;
}

void expectSameImage(const LinearImage& image, const LinearImage& reference, const std::string& what) {
    const Result<image::ImageDifference> difference =
        image::compareImages(image, reference, "image", "reference");
    ASSERT_TRUE(difference.ok()) << what << ": " << toString(difference.error());
    EXPECT_EQ(difference->nonFinite + difference->referenceNonFinite, 0U) << what;
    const image::LargestError& worst = difference->relative;
    EXPECT_LE(worst.value, 1e-4) << what << ": at (" << worst.x << ", " << worst.y << "), channel "
                                 << worst.channel;
}

}  // namespace glint::testing
