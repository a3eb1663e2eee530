// The pipelines of a strategy.
#pragma once

#include "context/resources.h"
#include "renderer/pipeline_jobs.h"

#include <glint/package.h>

#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

namespace glint {

// The choice among a package's modules that a renderer runs. Each field is one value, not a set.
struct PipelineChoice {
    package::Strategy strategy = package::kStrategyVisibility;
    package::Tracer tracer = package::kTracerRayQuery;
    package::Ordering ordering = package::Ordering::GlobalAtomics;
    bool checksOrder = false;
    bool batchEffects = false;
    std::uint32_t bounces = 1;  // the most of a path
};

// How pipelines are made.
struct PipelineMaking {
    std::uint32_t threads = 0;       // 0: as many as the machine runs at once
    bool captureStatistics = false;  // requires DeviceHandles::pipelineStatistics
};

// The pipeline of a pass: a compute pipeline, or a ray tracing pipeline with its shader binding table.
struct PassPipeline {
    VkPipeline pipeline = VK_NULL_HANDLE;
    bool traces = false;
    VkStridedDeviceAddressRegionKHR rayGeneration{};
    VkStridedDeviceAddressRegionKHR miss{};
    VkStridedDeviceAddressRegionKHR hit{};
};

// Members are destroyed in reverse order: the pool's memory last.
struct Pipelines {
    explicit Pipelines(Context::State& context) : pool(context) {}

    MemoryPool pool;
    std::vector<Buffer> tables;      // shader binding tables
    UniquePipelineLayout ownLayout;  // empty if the layout is the caller's
    VkPipelineLayout layout = VK_NULL_HANDLE;
    VkShaderStageFlags pushStages = 0;
    VkPipeline gbuffer = VK_NULL_HANDLE;
    std::map<package::ModuleRole, PassPipeline> passes;
    // Those of one effect, by role and package::effectNumber().
    std::map<std::pair<package::ModuleRole, std::uint32_t>, PassPipeline> effectPasses;
    std::vector<PassPipeline> cases;  // indexed by shader ID; cases that share a module share a pipeline
    std::vector<MadePipeline> owned;
    std::uint32_t threads = 0;  // threads that made them
    bool captureStatistics = false;
    double creationMs = 0.0;

    // Sets the pipeline of a role, and of the effect if each has one of its own.
    void add(const package::ModuleKey& key, const PassPipeline& pass);
};

// A layout that the caller has, or the sets of one to make.
struct LayoutSource {
    std::span<const VkDescriptorSetLayout> sets{};
    VkPipelineLayout given = VK_NULL_HANDLE;
    VkShaderStageFlags givenPushStages = 0;
};

// Returns the part of the package's shape that decides which of its modules the choice needs.
package::PackageShape chosenShape(const Package& package, const PipelineChoice& choice);

// Returns the stages that push constants are for.
VkShaderStageFlags pushStages(const Context::State& context);

// Returns the name of a pipeline for reports: the role of its module, and its case, effect or ordering.
std::string pipelineName(const Package& package, const package::ModuleKey& key);

// Makes all pipelines of the choice. `shaderIds` are those of the hit records of the strategy hit-shaders, in
// their order. Errors: those of buffers and submissions, "vulkan-call".
Result<Pipelines> createPipelines(Context::State& context, const Package& package,
                                  const PipelineChoice& choice, const PipelineMaking& making,
                                  std::span<const std::uint32_t> shaderIds, const LayoutSource& layout);

}  // namespace glint
