#include "device_fixture.h"

#include "support/must.h"

// Drivers and layers keep memory when they are unloaded, and no suppression can name them then. HostDevice's
// test detects what Glint leaves behind on a device. Only AddressSanitizer calls this.
extern "C" const char*
__asan_default_options();  // NOLINT(bugprone-reserved-identifier,readability-identifier-naming)
extern "C" const char*
__asan_default_options() {  // NOLINT(bugprone-reserved-identifier,readability-identifier-naming)
    return "detect_leaks=0:verify_asan_link_order=0";  // a library is preloaded
}

namespace glint::test {

SceneView TestScene::view() {
    primitiveViews_.clear();
    for (const Mesh& mesh : meshes) {
        PrimitiveView primitive;
        primitive.mesh = mesh.mesh;
        primitive.primitive = mesh.primitive;
        primitive.positions = mesh.positions;
        primitive.indices = mesh.indices;
        primitiveViews_.push_back(primitive);
    }
    imageViews_.clear();
    for (const Pixels& image : images) {
        imageViews_.push_back({image.width, image.height, image.bytes, image.format, image.levels});
    }
    return {.primitives = primitiveViews_,
            .instances = instances,
            .images = imageViews_,
            .lights = lights,
            .traversalOrder = traversalOrder,
            .vertices = SceneView::VertexForm::Full};  // the shaders of these tests read floats and words
}

TestScene::Mesh makeSquare(std::uint32_t mesh, std::uint32_t primitive, float z) {
    return {mesh, primitive, {{-1, -1, z}, {1, -1, z}, {1, 1, z}, {-1, 1, z}}, {0, 1, 2, 0, 2, 3}};
}

TestScene squareScene() {
    TestScene scene;
    scene.meshes = {makeSquare(0, 0)};
    scene.instances = {{0, kIdentity}};
    return scene;
}

CameraView makeCamera(float z) {
    CameraView camera;
    camera.position = {0, 0, z};
    camera.forward = {0, 0, z > 0 ? -1.0F : 1.0F};
    return camera;
}

void DeviceTest::SetUp() {
    HeadlessOptions options;
    options.validation = Validation::Synchronization;
    Result<std::unique_ptr<Context>> context = Context::createHeadless(options);
    if (!context) {
        GTEST_SKIP() << "no device to test on: " << toString(context.error());
    }
    context_ = std::move(*context);
}

void DeviceTest::TearDown() {
    if (context_ != nullptr) {
        for (const std::string& message : context_->validationMessages()) {
            ADD_FAILURE() << message;
        }
    }
}

Package DeviceTest::load(const PackageSpec& spec) {
    writePackage(spec, folder_.path());
    Result<Package> package = Package::load(folder_.path());
    if (!package) {
        ADD_FAILURE() << toString(package.error());
        std::abort();
    }
    return std::move(*package);
}

std::unique_ptr<GpuScene> DeviceTest::upload(const Package& package, TestScene& scene) {
    return must(GpuScene::upload(context(), package, scene.view()));
}

std::unique_ptr<Renderer> DeviceTest::makeRenderer(const Package& package, GpuScene& scene,
                                                   package::Strategy strategy, std::uint32_t width,
                                                   std::uint32_t height) {
    RendererOptions options;
    options.strategy = strategy;
    options.width = width;
    options.height = height;
    return must(Renderer::create(context(), package, scene, options));
}

}  // namespace glint::test
