// A scene and a device become pictures. These are the steps, in their order; programs have their own loop
// over frames and their own report:
//
//     auto opened = open(file, settings, store);
//     auto package = packageFor(build, opened->package, modules);  // `build` is what resolve() decided
//     SceneViewData data = sceneView(build.settings, opened->scene);
//     usePackage(*package, opened->scene, textures, data);
//     auto scene = DeviceScene::upload(context, package, std::move(data));
//     auto renderer = scene->makeRenderer(context, rendererOptions(build.settings));
//     renderer->render(frameOptions(build.settings, camera, sky, environment), samples);
#pragma once

#include "emit/package/compiled_package.h"
#include "gltf/import_options.h"
#include "gltf/scene.h"
#include "resolve/resolve.h"

#include <glint/context.h>
#include <glint/environment.h>
#include <glint/package.h>
#include <glint/renderer.h>
#include <glint/result.h>
#include <glint/session/scene_view.h>
#include <glint/session/sky.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace glint::compiler {
class CacheStore;
class ModuleCache;
}  // namespace glint::compiler

namespace glint::session {

struct TextureOptions;  // glint/session/textures.h

// --- Reading ---

// The parts of images that a program needs.
enum class ImageReading : std::uint8_t {
    None,
    Files,  // for loadTextures()
};

// Returns compiler::importOptions(), for a package that is there already if `package` is not null.
Result<gltf::ImportOptions> importOptions(const compiler::Settings& settings, ImageReading images,
                                          base::Memo* texels, const Package* package = nullptr);

// Loads the package that Settings::package names. Returns null if one is to be compiled.
Result<std::shared_ptr<const Package>> givenPackage(const compiler::Settings& settings);

// A scene that was read with the files of its images, for the package that Settings::package names.
struct Opened {
    std::shared_ptr<const Package> package;  // null if one is to be compiled
    gltf::Scene scene;
};
// `store` may be null. Has the errors of givenPackage(), importOptions() and importScene().
Result<Opened> open(const std::string& file, const compiler::Settings& settings, compiler::CacheStore* store);

// --- The package ---

// Returns the index of the scene within the package: the one with the file's name, or 0 if there is only one.
// Returns nothing if the package does not know the scene.
std::optional<std::uint32_t> sceneIn(const Package& package, const gltf::Scene& scene);

// Error "package-mismatch" unless `package` has what a build of one scene asks for, and was compiled from
// this scene: it must have the same materials, and for each primitive the same material and features. Error
// "package-tracer" if it lacks the tracer. Errors name Settings::package as their place.
Status checkPackage(const Package& package, const compiler::Build& build);

// Loads a package that was just compiled, from memory. Has the errors of Package::load().
Result<std::shared_ptr<const Package>> loadPackage(const compiler::CompiledPackage& compiled);

// Compiles a package and loads it. Modules that `cache` has are not compiled; it may be null. Has the errors
// of compilePackage().
Result<std::shared_ptr<const Package>> compileAndLoad(const compiler::Build& build,
                                                      compiler::ModuleCache* cache = nullptr);

// Returns `given` after checkPackage(). If it is null, does the same as compileAndLoad().
Result<std::shared_ptr<const Package>> packageFor(const compiler::Build& build,
                                                  std::shared_ptr<const Package> given,
                                                  compiler::ModuleCache* cache);

// --- Settings as the runtime takes them ---

HeadlessOptions deviceOptions(const compiler::Settings& settings);
// Returns how the scene's images are read for the device and the package. `cache` may be null.
TextureOptions textureOptions(const compiler::Settings& settings, const Context& context,
                              const Package& package, compiler::CacheStore* cache);
// Returns what a renderer is asked for. The strategy must be decided.
RendererOptions rendererOptions(const compiler::Settings& settings);
// Returns the sky that `sky` asks for. With `auto` it follows the lights at the pose of `scene`, from which
// `view` was made. A scene without lights of its own keeps the default sky, to which the sun belongs.
SkyChoice chooseSky(const compiler::Settings& settings, const gltf::Scene& scene, const SceneViewData& view);
// `environment` may be null.
FrameOptions frameOptions(const compiler::Settings& settings, const CameraView& camera, const SkyChoice& sky,
                          const Environment* environment);

// --- The scene ---

// Returns the scene as it is uploaded, with the light that it may lack and the sizes of lights.
SceneViewData sceneView(const compiler::Settings& settings, const gltf::Scene& scene);
// Adds what `package` decides: the scene's number in it and the layout of its records. Gives the images to
// `data`, unless `textures` is null.
void usePackage(const Package& package, const gltf::Scene& scene, std::shared_ptr<const TextureSet> textures,
                SceneViewData& data);

// A scene on a device, and the package with which it is drawn.
struct DeviceScene {
    std::shared_ptr<const Package> package;
    SceneViewData data;  // in its present pose
    std::unique_ptr<GpuScene> gpu;

    // Uploads the scene and waits for the device. Has the errors of GpuScene::upload().
    static Result<DeviceScene> upload(Context& context, std::shared_ptr<const Package> package,
                                      SceneViewData data);
    // Records the upload as that of the frame 0. It has the coarse levels of textures;
    // GpuScene::textureStream() brings the others. Has the errors of GpuScene::record().
    static Result<DeviceScene> record(Context& context, std::shared_ptr<const Package> package,
                                      SceneViewData data, VkCommandBuffer commands);
    // Has the errors of Renderer::create().
    Result<std::unique_ptr<Renderer>> makeRenderer(Context& context, const RendererOptions& options) const;
};

}  // namespace glint::session
