#include "render/harness.h"

#include "image/compare.h"
#include "support/must.h"
#include "support/shared_modules.h"

#include <glint/session/camera.h>
#include <glint/session/scene_view.h>
#include <glint/session/session.h>

#include <cmath>
#include <cstdlib>
#include <utility>

namespace glint::testing {

namespace {

// Fails each case during which the validation layers of the shared device said something.
class ValidationListener : public ::testing::EmptyTestEventListener {
public:
    explicit ValidationListener(const Context& context) : context_(context) {}

private:
    void OnTestEnd(const ::testing::TestInfo&) override {
        const std::vector<std::string> messages = context_.validationMessages();
        for (; reported_ < messages.size(); ++reported_) {
            ADD_FAILURE() << messages[reported_];
        }
    }

    const Context& context_;
    std::size_t reported_ = 0;
};

}  // namespace

Context& sharedContext() {
    static const std::unique_ptr<Context> context = [] {
        HeadlessOptions options;
        // For machines that have a driver and no layers.
        const bool unvalidated = std::getenv("GLINT_TESTS_UNVALIDATED") != nullptr;
        options.validation = unvalidated ? Validation::Off : Validation::Synchronization;
        options.shaderFloat16 = true;
        auto made = must(Context::createHeadless(options));
        ::testing::UnitTest::GetInstance()->listeners().Append(new ValidationListener(*made));
        return made;
    }();
    return *context;
}

std::unique_ptr<GpuScene> uploadScene(const Package& package, const SceneView& scene) {
    return must(GpuScene::upload(sharedContext(), package, scene));
}

std::unique_ptr<GpuScene> uploadScene(const Package& package, const gltf::Scene& scene,
                                      const std::function<void(SceneView&)>& change) {
    session::SceneViewData data = session::makeSceneView(scene);
    session::useLayoutOf(package, scene, data);
    SceneView view = data.view();
    if (change) {
        change(view);
    }
    return uploadScene(package, view);
}

std::unique_ptr<Renderer> makeRenderer(const Package& package, GpuScene& scene,
                                       const RendererOptions& options) {
    return must(Renderer::create(sharedContext(), package, scene, options));
}

LinearImage drawn(Renderer& renderer, const FrameOptions& frame, std::uint32_t samples) {
    return must(renderer.render(frame, samples));
}

LoadedScene::LoadedScene(const gltf::Scene& scene, const compiler::PlanOptions& plan)
    : LoadedScene(scene, compiler::CompileSettings{.plan = plan}) {}

LoadedScene::LoadedScene(const gltf::Scene& scene, const compiler::CompileSettings& settings,
                         const std::function<void(session::SceneViewData&)>& change) {
    compiled_ = must(compilePackage(scene, settings, &sharedModules()));
    auto package = must(session::loadPackage(compiled_));
    session::SceneViewData data = session::makeSceneView(scene);
    data.vertices = SceneView::VertexForm::Full;  // pictures are compared with exact ones
    if (scene.lights.empty()) {
        data.lights.push_back(session::sunLight());
    }
    if (change) {
        change(data);
    }
    session::useLayoutOf(*package, scene, data);
    device_ = must(session::DeviceScene::upload(sharedContext(), std::move(package), std::move(data)));
}

LinearImage LoadedScene::render(package::Strategy strategy, const RenderSetup& setup,
                                Renderer::Counters* counters) const {
    return render(RendererOptions{.strategy = strategy}, setup, counters);
}

LinearImage LoadedScene::render(RendererOptions options, const RenderSetup& setup,
                                Renderer::Counters* counters) const {
    options.width = setup.width;
    options.height = setup.height;
    options.countsLight = options.countsLight || setup.countsLight;
    if (!renderer_ || options_ != options) {
        renderer_.reset();
        renderer_ = makeRenderer(options);
        options_ = options;
    }
    LinearImage image = drawn(*renderer_, setup.frame, setup.samples);
    if (counters != nullptr) {
        *counters = must(renderer_->counters());
        EXPECT_EQ(counters->unknownShader, 0U);
    }
    return image;
}

PosedScene::PosedScene(gltf::Scene posed, std::shared_ptr<const LoadedScene> loaded,
                       const std::function<void(session::SceneViewData&)>& change)
    : scene(std::move(posed)), compiled(std::move(loaded)), data(session::makeSceneView(scene)) {
    data.moves = true;
    if (change) {
        change(data);
    }
    session::useLayoutOf(package(), scene, data);
    gpuScene = uploadScene(package(), data.view());
}

GpuScene::MotionStatistics PosedScene::update(MotionView::Builds builds) {
    session::poseSceneView(scene, data);
    MotionView motion = data.motion();
    motion.builds = builds;
    must(gpuScene->updateAndWait(motion));
    return must(gpuScene->motion());
}

RenderSetup defaultSetup(const gltf::Scene& scene, std::uint32_t width, std::uint32_t height) {
    RenderSetup setup;
    setup.width = width;
    setup.height = height;
    const session::SceneViewData data = session::makeSceneView(scene);
    const double aspect = static_cast<double>(width) / height;
    const Result<session::CameraChoice> camera = session::chooseCamera(scene, data, "", aspect);
    setup.frame.camera = camera ? camera->view : session::framingCamera(session::worldBounds(data), aspect);
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
