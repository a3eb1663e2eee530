// Passes that a ray tracing pipeline runs.
#pragma once

#include "pipelines.h"
#include "ray_pipelines.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace glint {

// What a ray tracing pipeline is to be made of, and what for.
struct RayPass {
    std::string name;  // for reports
    package::ModuleRole role{};
    RayPipelineSource source;
    // Of cases, which share a pipeline: by shader ID the ray generation shader of the source; retired ones
    // have none.
    std::map<std::uint32_t, std::size_t> shaderOfCase;
};

// Those of the choice. `shaderIds`: of the scene's geometry records, in their order. The sources point into
// the package.
std::vector<RayPass> planRayPasses(const Package& package, const PipelineChoice& choice,
                                   std::span<const std::uint32_t> shaderIds);

// SPIR-V of all stages.
std::size_t wordCount(const RayPipelineSource& source);

// Makes the table of the pass, whose pipeline is among those that `pipelines` owns, and adds what it is for.
// Errors: those of buffers and submissions, "vulkan-call".
Status addRayPass(Context::State& context, const Package& package, const RayPass& pass, VkPipeline pipeline,
                  Pipelines& pipelines);

}  // namespace glint
