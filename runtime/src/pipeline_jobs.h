// Pipelines that are made by several threads at once.
#pragma once

#include "shader_modules.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace glint {

struct PipelineJob {
    std::string name;           // of the pipeline, for reports
    std::size_t wordCount = 0;  // of its SPIR-V: how much work it may be
    // Called from any thread, with nothing that another job changes.
    std::function<Result<UniquePipeline>(PipelineCreation& creation)> make;
};

struct MadePipeline {
    std::string name;
    UniquePipeline handle;
    VkPipelineCreationFeedback feedback{};  // without the flag VALID: the driver says nothing
};

// Threads for that many jobs, where `wanted` are asked for; 0: as many as the machine runs at once.
std::uint32_t pipelineThreads(std::uint32_t wanted, std::size_t jobCount);

// The pipelines in order of their jobs, whatever the order in which they were made: the largest is begun
// first. `threads`: this one included, and not 0; fewer where the system gives no more. All jobs run; the
// error is that of the first that failed.
Result<std::vector<MadePipeline>> makePipelines(std::span<const PipelineJob> jobs,
                                                VkPipelineCreateFlags flags, std::uint32_t threads);

}  // namespace glint
