// Passes that are ray tracing pipelines.
#pragma once

#include "pipelines.h"

#include <cstdint>
#include <span>

namespace glint {

// Adds those of the choice to `pipelines`, whose layout is there. `shaderIds`: of the scene's geometry
// records, in their order. Errors: those of buffers and submissions, "vulkan-call".
Status createRayPasses(Context::State& context, const Package& package, const PipelineChoice& choice,
                       std::span<const std::uint32_t> shaderIds, Pipelines& pipelines);

}  // namespace glint
