// Shader modules, and pipelines of one module.
#pragma once

#include "device_handle.h"

#include <cstdint>
#include <span>

namespace glint {

// Error "vulkan-call".
Result<UniqueShaderModule> createShaderModule(Context::State& context, std::span<const std::uint32_t> words);

// The entry point is "main".
VkPipelineShaderStageCreateInfo stageOf(VkShaderStageFlagBits stage, VkShaderModule module);

// How a pipeline is to be made, and what the driver says of how it was.
struct PipelineCreation {
    VkPipelineCreateFlags flags = 0;
    std::uint32_t threads =
        0;  // of a compute shader's workgroup, where that is its constant 0; 0: it has none
    VkPipelineCreationFeedback feedback{};  // without the flag VALID: nothing
};

// Error "vulkan-call".
Result<UniquePipeline> createComputePipeline(Context::State& context, std::span<const std::uint32_t> words,
                                             VkPipelineLayout layout, PipelineCreation& creation);
Result<UniquePipeline> createComputePipeline(Context::State& context, std::span<const std::uint32_t> words,
                                             VkPipelineLayout layout);

// For the chain of a pipeline's creation; fills `creation`, which must outlive it.
VkPipelineCreationFeedbackCreateInfo feedbackOf(PipelineCreation& creation);

}  // namespace glint
