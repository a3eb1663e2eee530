// Layouts of descriptor sets and pipelines, and sets with a pool of their own.
#pragma once

#include "context/device_handle.h"

#include <glint/result.h>

#include <span>

namespace glint {

// `flags` are those of each binding, or empty. Errors: "vulkan-call".
Result<UniqueSetLayout> createSetLayout(Context::State& context,
                                        std::span<const VkDescriptorSetLayoutBinding> bindings,
                                        std::span<const VkDescriptorBindingFlags> flags = {});

struct DescriptorSet {
    UniqueDescriptorPool pool;
    VkDescriptorSet set = VK_NULL_HANDLE;
};

// Makes a pool that has exactly one set. With `updates` the set may be written after it is bound. Errors:
// "vulkan-call".
Result<DescriptorSet> createSet(Context::State& context, VkDescriptorSetLayout layout,
                                std::span<const VkDescriptorSetLayoutBinding> bindings, bool updates);

// Errors: "vulkan-call".
Result<UniquePipelineLayout> createPipelineLayout(Context::State& context,
                                                  std::span<const VkDescriptorSetLayout> sets,
                                                  const VkPushConstantRange& range);

}  // namespace glint
