// Pipelines of a strategy.
#pragma once

#include "device_handle.h"

#include <glint/package.h>

#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace glint {

// Which of a package's modules a renderer runs. Each field is one value, not a set.
struct PipelineChoice {
    package::Strategy strategy = package::kStrategyVisibility;
    package::Tracer tracer = package::kTracerRayQuery;
    package::Ordering ordering = package::Ordering::GlobalAtomics;
    bool checksOrder = false;
};

// A pass: a compute pipeline, or a ray tracing pipeline with its shader binding table.
struct PassPipeline {
    VkPipeline pipeline = VK_NULL_HANDLE;
    bool traces = false;
    VkStridedDeviceAddressRegionKHR rayGeneration{};
    VkStridedDeviceAddressRegionKHR miss{};
    VkStridedDeviceAddressRegionKHR hit{};
};

struct Pipelines {
    UniquePipelineLayout layout;
    VkPipeline gbuffer = VK_NULL_HANDLE;
    std::map<package::ModuleRole, PassPipeline> passes;
    std::vector<PassPipeline> cases;  // by shader ID; cases that share a module share a pipeline
    std::vector<UniquePipeline> owned;
    double creationMs = 0.0;
};

// All pipelines of the choice. Errors: "vulkan-call".
Result<Pipelines> createPipelines(Context::State& context, const Package& package,
                                  const PipelineChoice& choice,
                                  std::span<const VkDescriptorSetLayout> setLayouts);

}  // namespace glint
