// A program that links the runtime alone. It contains the code that the README shows, so that this code
// compiles.
#include <glint/renderer.h>

#include <iostream>

struct Reflections {
    std::unique_ptr<glint::Context> context;
    std::unique_ptr<glint::GpuScene> scene;
    std::unique_ptr<glint::Renderer> renderer;
};

// Called once, with your device and your geometry.
glint::Result<Reflections> createReflections(const glint::DeviceHandles& device, const glint::SceneView& view,
                                             const char* packageFolder) {
    Reflections made;
    glint::Result<glint::Package> package = glint::Package::load(packageFolder);
    if (!package) {
        return package.error();
    }
    glint::Result<std::unique_ptr<glint::Context>> context = glint::Context::adopt(device);
    if (!context) {
        return context.error();  // names every feature that the device lacks
    }
    made.context = std::move(*context);
    glint::Result<std::unique_ptr<glint::GpuScene>> scene =
        glint::GpuScene::upload(*made.context, *package, view);
    if (!scene) {
        return scene.error();
    }
    made.scene = std::move(*scene);
    glint::Result<std::unique_ptr<glint::Renderer>> renderer = glint::Renderer::create(
        *made.context, *package, *made.scene, {glint::package::kStrategyVisibility, 1280, 720});
    if (!renderer) {
        return renderer.error();
    }
    made.renderer = std::move(*renderer);
    return made;
}

// Called every frame, with your command buffer. The picture is then in renderer->output().
glint::Status recordReflections(Reflections& reflections, VkCommandBuffer commands,
                                const glint::CameraView& camera) {
    glint::FrameOptions frame;
    frame.camera = camera;
    return reflections.renderer->record(commands, frame);
}

int main(int argc, char** argv) {
    // There is no such package, and the error is a value that says so. No device was needed to find out.
    const glint::Result<Reflections> made = createReflections({}, {}, argc > 1 ? argv[1] : "");
    if (made || made.error().message.empty()) {
        return 1;
    }
    std::cout << glint::toString(made.error()) << '\n';
    return 0;
}
