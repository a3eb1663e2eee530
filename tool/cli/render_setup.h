// Converts the arguments of glint render to settings of the compiler and of the runtime.
#pragma once

#include "cli/render_arguments.h"
#include "cli/scene_view.h"
#include "cli/sky_choice.h"
#include "emit/compile.h"

#include <glint/renderer.h>

#include <cstdint>

namespace glint {

// Returns the scene as it is uploaded, with the light that it may lack and the sizes of lights.
SceneViewData sceneView(const RenderArguments& arguments, const Scene& scene);

// Returns the settings of the package that is compiled if none is given. `tracers` are those of the device.
CompileSettings compileSettings(const RenderArguments& arguments, const PlanOptions& plan,
                                std::uint32_t tracers, const Scene& scene);

RendererOptions rendererOptions(const RenderArguments& arguments);

// Returns the sky that --sky asks for. With `auto` it follows the lights at the pose of `scene`, from which
// `view` was made. A scene without lights of its own keeps the default sky, to which the sun belongs.
SkyChoice chooseSky(const RenderArguments& arguments, const Scene& scene, const SceneViewData& view);

// `environment` may be null.
FrameOptions frameOptions(const RenderArguments& arguments, const CameraView& camera, const SkyChoice& sky,
                          const Environment* environment);

}  // namespace glint
