// What a renderer runs, from its options, its package and the device.
#pragma once

#include "frame_resources.h"
#include "pipelines.h"

#include <glint/package.h>
#include <glint/renderer.h>

namespace glint {

// Errors: "renderer-options" (not one strategy, tracer or ordering), "package-strategy", "package-tracer"
// (the package lacks it), "device-tracer" (the device does), "device-ordering".
Result<PipelineChoice> choosePipelines(const Context::State& context, const Package& package,
                                       const RendererOptions& options);

FrameSize frameSize(const Package& package, const PipelineChoice& choice, const RendererOptions& options);

}  // namespace glint
