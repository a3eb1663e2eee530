// The pipelines of a strategy: the plan of what a choice of a package's modules consists of, and the passes
// that they serve.
#pragma once

#include "context/resources.h"
#include "frame/frame_resources.h"
#include "renderer/background_pipelines.h"
#include "renderer/pipeline_jobs.h"

#include <glint/package.h>
#include <glint/renderer_options.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace glint {

// The choice among a package's modules that a renderer runs. Each field is one value, not a set.
struct PipelineChoice {
    package::Strategy strategy = package::kDefaultStrategy;
    package::Tracer tracer = package::kTracerRayQuery;
    package::Ordering ordering = package::Ordering::GlobalAtomics;
    bool checksOrder = false;
    bool batchEffects = false;
    std::uint32_t bounces = 1;  // the most of a path
    std::uint32_t bands = 1;    // 0: chosen for the frame
    // Pipelines with shaders of cases are made later, by threads; until then a fallback replaces them.
    bool background = false;
    // Frames begin with a draft. Requires `background`.
    bool draft = false;
    bool halfPicture = false;  // as FrameSize::halfPicture
    bool countsLight = false;  // as RendererOptions::countsLight
};

// --- The choice of a renderer by its options, its package and the device (renderer_choice.cpp) ---

// Errors: "renderer-options" (not exactly one strategy, tracer or ordering), "package-strategy" and
// "package-tracer" (the package lacks it), "device-tracer" and "device-ordering" (the device lacks it).
Result<PipelineChoice> choosePipelines(const Context::State& context, const Package& package,
                                       const RendererOptions& options);

// Returns the rows of a band, or 0 for a frame that is lit as a whole. Pure.
std::uint32_t chooseBandRows(const FrameSize& size, std::uint32_t bands);

// Returns the bytes of a shadow ray of a first hit that waits in memory; 0 if they are traced inline.
std::uint32_t firstShadowBytes(const Package& package);

// Returns whether frames have a picture of 16-bit floats: the options request it, and nothing needs 32 bits.
// The march in screen space reads depths from it, and shaders have one format for the picture and for layers
// of 32-bit vectors.
bool hasHalfPicture(const Package& package, const RendererOptions& options);

FrameSize frameSize(const Package& package, const PipelineChoice& choice, const RendererOptions& options,
                    std::uint32_t textures);

// --- Its pipelines ---

// Returns the stages of the passes that are not raster passes.
inline VkPipelineStageFlags2 stagesOf(const PipelineChoice& choice) {
    const bool rayPipeline = choice.tracer == package::kTracerRayPipeline;
    return VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT |
           (rayPipeline ? VK_PIPELINE_STAGE_2_RAY_TRACING_SHADER_BIT_KHR : VK_PIPELINE_STAGE_2_NONE);
}

// The settings for making pipelines.
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

// Members are destroyed in reverse order: first the threads end, and the pool's memory is freed last.
struct Pipelines {
    explicit Pipelines(Context::State& context) : pool(context, "shader binding tables") {}

    MemoryPool pool;
    std::vector<Buffer> tables;  // shader binding tables
    // Null if the layout is the caller's.
    std::shared_ptr<const UniquePipelineLayout> ownLayout;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    VkShaderStageFlags pushStages = 0;
    VkPipeline gbuffer = VK_NULL_HANDLE;
    std::map<package::ModuleRole, PassPipeline> passes;
    // The passes of one effect, by role and package::effectNumber().
    std::map<std::pair<package::ModuleRole, std::uint32_t>, PassPipeline> effectPasses;
    // Those of passes over buckets, by role and shader ID. Cases that share a module share a pipeline.
    std::map<package::ModuleRole, std::vector<PassPipeline>> cases;
    std::vector<MadePipeline> owned;
    std::shared_ptr<const Package> package;  // the package that threads read; null if the caller keeps it
    std::uint32_t threads = 0;               // threads that made them
    bool captureStatistics = false;
    double creationMs = 0.0;
    // Hits may have shader IDs that no case has, and the package's fallback shades them.
    bool shadesUnknown = false;
    // Frames are drafts until the fixed passes are there. Then the fallback of `drafted`, which the caller
    // keeps, stands in for the cases of `choice`.
    bool draft = false;
    const Package* drafted = nullptr;
    PipelineChoice choice;
    std::unique_ptr<BackgroundPipelines> background;  // null if all pipelines were made at once
    std::size_t adoptedAtOnce = std::numeric_limits<std::size_t>::max();  // the most in a recording

    // Makes room for the cases of a choice of the package's modules.
    void makeRoom(const Package& made, package::Strategy strategy);
    // Sets the pipeline of a role, and of the case or effect if each has one of its own.
    void add(const package::ModuleKey& key, const PassPipeline& pass);
};

// A layout that the caller has, or the sets of one to make.
struct LayoutSource {
    std::span<const VkDescriptorSetLayout> sets{};
    VkPipelineLayout given = VK_NULL_HANDLE;
    VkShaderStageFlags givenPushStages = 0;
};

// Makes a layout with push constants for all stages. Error "vulkan-call".
Result<UniquePipelineLayout> createPassLayout(Context::State& context,
                                              std::span<const VkDescriptorSetLayout> sets,
                                              std::uint32_t pushBytes);

// Returns the name of a pipeline for reports: the role of its module, and its case, effect or ordering.
std::string pipelineName(const Package& package, const package::ModuleKey& key);

// Makes all pipelines of the choice, or starts threads that make some of them later, which read `package`.
// `shaderIds` are those of the hit records of strategies with a pipeline of their own, in their order.
// Errors: those of buffers, "vulkan-call".
Result<Pipelines> createPipelines(Context::State& context, const Package& package,
                                  const PipelineChoice& choice, const PipelineMaking& making,
                                  std::span<const std::uint32_t> shaderIds, const LayoutSource& layout);

// Replaces the fallback by the pipelines that threads have made since the last call, and the draft by all
// fixed passes together. The passes that are recorded afterwards use them. Errors: those of buffers,
// "vulkan-call".
Status adoptPipelines(Context::State& context, Pipelines& pipelines);

// Returns the pipelines of the choice. Their jobs read `package`. `shaderIds` are those of the scene's
// geometry records, in their order.
std::vector<PlannedPipeline> planPipelines(Context::State& context, const Package& package,
                                           const PipelineChoice& choice,
                                           std::span<const std::uint32_t> shaderIds, VkPipelineLayout layout);

// Makes the pipelines in the call. The error is that of the first that failed.
Result<std::vector<BackgroundPipelines::Done>> makeNow(std::vector<PlannedPipeline> plan,
                                                       const PipelineMaking& making);
// Starts threads that make the pipelines while frames are drawn.
std::unique_ptr<BackgroundPipelines> makeLater(Context::State& context, std::vector<PlannedPipeline> plan,
                                               const PipelineMaking& making);

// Takes a pipeline, and lets the passes that it serves use it. Errors: those of buffers, "vulkan-call".
Status addPipeline(Context::State& context, const PlannedPipeline& planned, MadePipeline made,
                   Pipelines& pipelines);

// Lets the fallback replace the pipelines that are made later.
void addFallback(const Package& package, const PipelineChoice& choice, Pipelines& pipelines);

// Returns whether the package's fallback shades some of `shaderIds`, because no case has them.
bool hasUnknown(const Package& package, std::span<const std::uint32_t> shaderIds);

}  // namespace glint
