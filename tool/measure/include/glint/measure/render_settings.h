// Settings as the runtime takes them.
#pragma once

#include "gltf/scene.h"
#include "resolve/build.h"
#include "settings/descriptor.h"

#include <glint/context.h>
#include <glint/package.h>
#include <glint/renderer.h>
#include <glint/scene_view/scene_view.h>
#include <glint/scene_view/sky.h>
#include <glint/scene_view/textures.h>

#include <cstdint>

namespace glint::measure {

// Returns the facts of one of a build's scenes on which the values worth trying depend. BenchFacts of the
// device are left out.
compiler::BenchFacts factsOf(const compiler::Build& build, std::size_t scene = 0);

HeadlessOptions deviceOptions(const compiler::Settings& settings);
// Returns the scene as it is uploaded, with the light that it may lack and the sizes of lights.
scene_view::SceneViewData sceneView(const compiler::Settings& settings, const gltf::Scene& scene);
// Returns how the scene's images are read for the device and the package. `cache` may be null.
scene_view::TextureOptions textureOptions(const compiler::Settings& settings, const Context& context,
                                          const Package& package, compiler::CacheStore* cache);
// Gives lights the sizes that the settings ask for.
void sizeLights(const compiler::Settings& settings, scene_view::SceneViewData& scene);
// Returns what a renderer is asked for. The strategy must be decided.
RendererOptions rendererOptions(const compiler::Settings& settings);
// Returns the sky that `sky` asks for. With `auto` it follows the lights at the pose of `scene`, from which
// `view` was made. A scene without lights of its own keeps the default sky, to which the sun belongs.
scene_view::SkyChoice chooseSky(const compiler::Settings& settings, const gltf::Scene& scene,
                                const scene_view::SceneViewData& view);
// `environment` may be null.
FrameOptions frameOptions(const compiler::Settings& settings, const CameraView& camera,
                          const scene_view::SkyChoice& sky, const Environment* environment);

}  // namespace glint::measure
