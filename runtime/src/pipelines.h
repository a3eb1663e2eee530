// Pipelines of a strategy.
#pragma once

#include "device_handle.h"

#include <glint/package.h>

#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace glint {

struct Pipelines {
    UniquePipelineLayout layout;
    VkPipeline gbuffer = VK_NULL_HANDLE;
    std::map<package::ModuleRole, VkPipeline> passes;  // compute
    std::vector<VkPipeline> cases;  // by shader ID; cases that share a module share a pipeline
    std::vector<UniquePipeline> owned;
    double creationMs = 0.0;
};

// All pipelines that `strategy` needs. Errors: "vulkan-call".
Result<Pipelines> createPipelines(Context::State& context, const Package& package, package::Strategy strategy,
                                  std::span<const VkDescriptorSetLayout> setLayouts);

}  // namespace glint
