// Plans the pipelines that a choice of a package's modules consists of, and joins them to the passes.
#pragma once

#include "renderer/background_pipelines.h"
#include "renderer/pipelines.h"

#include <cstdint>
#include <span>
#include <vector>

namespace glint {

// Returns the pipelines of the choice. Their jobs read `package`. `shaderIds` are those of the scene's
// geometry records, in their order.
std::vector<PlannedPipeline> planPipelines(Context::State& context, const Package& package,
                                           const PipelineChoice& choice,
                                           std::span<const std::uint32_t> shaderIds, VkPipelineLayout layout);

// Takes a pipeline, and lets the passes that it serves use it. Errors: those of buffers, "vulkan-call".
Status addPipeline(Context::State& context, const PlannedPipeline& planned, MadePipeline made,
                   Pipelines& pipelines);

// Lets the fallback replace the pipelines that are made later.
void addFallback(const Package& package, const PipelineChoice& choice, Pipelines& pipelines);

// Returns whether the package's fallback shades some of `shaderIds`, because no case has them.
bool hasUnknown(const Package& package, std::span<const std::uint32_t> shaderIds);

}  // namespace glint
