// A program that hands a glTF scene to the runtime: the scene with its pixels, the camera, and the package,
// which it compiles in memory. It has no device, so it stops before the upload.
#include "gltf/import.h"

#include <glint/session/camera.h>
#include <glint/session/scene_view.h>
#include <glint/session/session.h>

#include <cstddef>
#include <iostream>
#include <span>

int main(int argc, char** argv) {
    glint::gltf::ImportOptions import;
    import.decodeImages = true;
    const glint::Result<glint::gltf::Scene> scene = glint::gltf::importScene(argc > 1 ? argv[1] : "", import);
    if (!scene) {
        std::cerr << glint::toString(scene.error()) << '\n';
        return 1;
    }
    const glint::session::SceneViewData data = glint::session::makeSceneView(*scene);
    const glint::SceneView view = data.view();
    const glint::Result<glint::session::CameraChoice> camera =
        glint::session::chooseCamera(*scene, data, "auto", 16.0 / 9.0);
    const auto build = glint::compiler::resolve(std::span(&*scene, 1), glint::compiler::CompileSettings());
    if (!build) {
        std::cerr << glint::toString(build.error()) << '\n';
        return 1;
    }
    const auto package = glint::session::compileAndLoad(*build);
    if (!camera || !package) {
        std::cerr << glint::toString(camera ? package.error() : camera.error()) << '\n';
        return 1;
    }
    const glint::Status matches = glint::session::checkPackage(**package, *build);
    if (!matches) {
        std::cerr << glint::toString(matches.error()) << '\n';
        return 1;
    }
    std::size_t triangles = 0;
    for (const glint::PrimitiveView& primitive : view.primitives) {
        triangles += primitive.indices.size() / 3;
    }
    std::cout << view.instances.size() << " instances, " << triangles << " triangles, " << view.images.size()
              << " images, " << (*package)->caseCount() << " cases, camera " << camera->name << '\n';
    return 0;
}
