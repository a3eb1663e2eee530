// Makes pipelines with several threads at once.
#pragma once

#include "package/shader_modules.h"
#include "replacement/pipeline_identity.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace glint {

struct PipelineJob {
    std::string name;           // name of the pipeline, for reports
    std::size_t wordCount = 0;  // words of its SPIR-V, which estimate the work
    // Any thread may call this. It must use nothing that another job changes.
    std::function<Result<UniquePipeline>(PipelineCreation& creation)> make;
    PipelineIdentity identity{};
};

struct MadePipeline {
    std::string name;
    std::shared_ptr<const UniquePipeline> handle;  // shared with the pipelines of a package that follows
    VkPipelineCreationFeedback feedback{};         // without the flag VALID the driver gives no feedback
    PipelineIdentity identity{};
};

// Returns the number of threads for that many jobs, at most `wanted`. 0 asks for as many as the machine runs
// at once.
std::uint32_t pipelineThreads(std::uint32_t wanted, std::size_t jobCount);

// Returns the pipelines, or the errors that prevented them, in the order of their jobs. The largest job
// begins first. `threads` includes the calling thread and must not be 0; if the system gives fewer threads,
// fewer are used.
std::vector<Result<MadePipeline>> tryPipelines(std::span<const PipelineJob> jobs, VkPipelineCreateFlags flags,
                                               std::uint32_t threads);

// As tryPipelines(). All jobs run. The error is that of the first job that failed.
Result<std::vector<MadePipeline>> makePipelines(std::span<const PipelineJob> jobs,
                                                VkPipelineCreateFlags flags, std::uint32_t threads);

}  // namespace glint
