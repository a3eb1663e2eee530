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

// Error "vulkan-call".
Result<UniquePipeline> createComputePipeline(Context::State& context, std::span<const std::uint32_t> words,
                                             VkPipelineLayout layout);

}  // namespace glint
