// Chooses the modules and the settings of a renderer from its options, its package and the device.
#pragma once

#include "frame/frame_resources.h"
#include "renderer/pipelines.h"

#include <glint/internal/package_modules.h>
#include <glint/package.h>
#include <glint/renderer_options.h>

#include <cstdint>

namespace glint {

// Errors: "renderer-options" (not exactly one strategy, tracer or ordering), "package-strategy" and
// "package-tracer" (the package lacks it), "device-tracer" and "device-ordering" (the device lacks it).
Result<PipelineChoice> choosePipelines(const Context::State& context, const Package& package,
                                       const RendererOptions& options);

// Returns the rows of a band, or 0 for a frame that is lit as a whole. Pure.
std::uint32_t chooseBandRows(const FrameSize& size, std::uint32_t bands);

// Returns the bytes of a shadow ray of a first hit that waits in memory; 0 if they are traced inline.
std::uint32_t firstShadowBytes(const Package& package);

// Returns whether frames have a picture of 16-bit floats: the options request it, and nothing needs 32 bits.
// The march in screen space reads depths from it, and shaders have one format for the picture and for layers
// of 32-bit vectors.
bool hasHalfPicture(const Package& package, const RendererOptions& options);

FrameSize frameSize(const Package& package, const PipelineChoice& choice, const RendererOptions& options,
                    std::uint32_t textures);

}  // namespace glint
