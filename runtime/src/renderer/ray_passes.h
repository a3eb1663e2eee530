// The passes that a ray tracing pipeline runs.
#pragma once

#include "renderer/pipelines.h"
#include "renderer/ray_pipelines.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace glint {

// The parts of a ray tracing pipeline, and the pass that it serves.
struct RayPass {
    std::string name;  // for reports
    package::ModuleKey key;
    RayPipelineSource source;
    std::vector<std::uint32_t> shaderIds{};  // of the cases that a pass of cases shades
    PipelineTurn turn = PipelineTurn::First;
};

// Plans the ray passes of the choice. `shaderIds` are those of the scene's geometry records, in their order.
// The sources point into the package.
std::vector<RayPass> planRayPasses(const Package& package, const PipelineChoice& choice,
                                   std::span<const std::uint32_t> shaderIds);

// Returns the number of SPIR-V words of all stages.
std::size_t wordCount(const RayPipelineSource& source);

// Makes the shader binding table of the pass and adds the pass to `pipelines`, which must own `pipeline`.
// Errors: those of buffers, "vulkan-call".
Status addRayPass(Context::State& context, const RayPass& pass, VkPipeline pipeline, Pipelines& pipelines);

}  // namespace glint
