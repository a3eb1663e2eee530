// Reads a driver's report about a pipeline.
#pragma once

#include "context/context_state.h"
#include "renderer/pipeline_jobs.h"

#include <glint/pipeline_statistics.h>

#include <vector>

namespace glint {

// Requires DeviceHandles::pipelineStatistics and a pipeline that was made with
// VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR. Error "vulkan-call".
Result<std::vector<PipelineExecutable>> readExecutables(const Context::State& context, VkPipeline pipeline);

// Returns the way in which the pipeline was made, without its executables.
PipelineStatistics describe(const MadePipeline& pipeline);

}  // namespace glint
