// Settings as compiler and runtime take them, once the scene and the device are known.
#pragma once

#include "gltf/scene.h"
#include "settings/configuration.h"

#include <glint/context.h>
#include <glint/package.h>
#include <glint/renderer.h>
#include <glint/scene_view/scene_view.h>
#include <glint/scene_view/sky.h>
#include <glint/scene_view/textures.h>

#include <cstdint>
#include <vector>

namespace glint::measure {

// Returns the facts of the scene and the request on which the values worth trying depend. BenchFacts of the
// device are left out.
compiler::BenchFacts factsOf(const compiler::Settings& settings, const gltf::Scene& scene,
                             const compiler::PlanOptions& plan);

// Returns whether the picture gets a light that the scene lacks.
bool addsSun(const compiler::Settings& settings, const gltf::Scene& scene);
HeadlessOptions deviceOptions(const compiler::Settings& settings);
// Returns the scene as it is uploaded, with the light that it may lack and the sizes of lights.
scene_view::SceneViewData sceneView(const compiler::Settings& settings, const gltf::Scene& scene);
// Returns how the scene's images are read for the device and the package. `cache` may be null.
scene_view::TextureOptions textureOptions(const compiler::Settings& settings, const Context& context,
                                          const Package& package, compiler::CacheStore* cache);
// Gives lights the sizes that the settings ask for.
void sizeLights(const compiler::Settings& settings, scene_view::SceneViewData& scene);
// Returns the settings of a package with these strategies and tracers.
compiler::CompileSettings compileSettings(const compiler::Settings& settings,
                                          const compiler::PlanOptions& plan);
// Returns the settings of the package that is compiled for a picture if none is given. `tracers` are those of
// the device.
compiler::CompileSettings compileSettings(const compiler::Settings& settings,
                                          const compiler::PlanOptions& plan, std::uint32_t tracers,
                                          const gltf::Scene& scene);
RendererOptions rendererOptions(const compiler::Settings& settings);
// Returns the sky that `sky` asks for. With `auto` it follows the lights at the pose of `scene`, from which
// `view` was made. A scene without lights of its own keeps the default sky, to which the sun belongs.
scene_view::SkyChoice chooseSky(const compiler::Settings& settings, const gltf::Scene& scene,
                                const scene_view::SceneViewData& view);
// `environment` may be null.
FrameOptions frameOptions(const compiler::Settings& settings, const CameraView& camera,
                          const scene_view::SkyChoice& sky, const Environment* environment);

}  // namespace glint::measure
