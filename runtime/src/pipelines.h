// Pipelines of a strategy.
#pragma once

#include "resources.h"

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
    bool batchEffects = false;
};

// A pass: a compute pipeline, or a ray tracing pipeline with its shader binding table.
struct PassPipeline {
    VkPipeline pipeline = VK_NULL_HANDLE;
    bool traces = false;
    VkStridedDeviceAddressRegionKHR rayGeneration{};
    VkStridedDeviceAddressRegionKHR miss{};
    VkStridedDeviceAddressRegionKHR hit{};
};

// Members are destroyed in reverse: the pool's memory last.
struct Pipelines {
    explicit Pipelines(Context::State& context) : pool(context) {}

    MemoryPool pool;
    std::vector<Buffer> tables;  // shader binding tables
    UniquePipelineLayout layout;
    VkPipeline gbuffer = VK_NULL_HANDLE;
    std::map<package::ModuleRole, PassPipeline> passes;
    std::vector<PassPipeline> effectRays;  // by package::effectNumber()
    std::vector<PassPipeline> cases;       // by shader ID; cases that share a module share a pipeline
    std::vector<UniquePipeline> owned;
    double creationMs = 0.0;
};

// What decides which of the package's modules the choice has.
package::PackageShape chosenShape(const Package& package, const PipelineChoice& choice);

// Stages that push constants are for.
VkShaderStageFlags pushStages(const Context::State& context);

// All pipelines of the choice. `shaderIds`: of the scene's geometry records, in their order. Errors: those of
// buffers and submissions, "vulkan-call".
Result<Pipelines> createPipelines(Context::State& context, const Package& package,
                                  const PipelineChoice& choice, std::span<const std::uint32_t> shaderIds,
                                  std::span<const VkDescriptorSetLayout> setLayouts);

}  // namespace glint
