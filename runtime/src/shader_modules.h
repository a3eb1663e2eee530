// Shader modules, and the stages of pipelines that are made of them.
#pragma once

#include "device_handle.h"

#include <cstdint>
#include <span>

namespace glint {

// Error "vulkan-call".
Result<UniqueShaderModule> createShaderModule(Context::State& context, std::span<const std::uint32_t> words);

// The entry point is "main".
VkPipelineShaderStageCreateInfo stageOf(VkShaderStageFlagBits stage, VkShaderModule module);

}  // namespace glint
