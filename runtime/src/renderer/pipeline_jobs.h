// Makes pipelines, with several threads at once, and reads the driver's report about them.
#pragma once

#include "context/context.h"
#include "context/resources.h"
#include "context/shader_modules.h"

#include <glint/internal/package_modules.h>
#include <glint/package.h>
#include <glint/renderer.h>

#include <vulkan/vulkan_core.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <tuple>
#include <vector>

namespace glint {

using SpirvWords = std::span<const std::uint32_t>;

// The modules of a pipeline and of its table. Its rays do not recurse.
struct RayPipelineSource {
    SpirvWords rayGeneration;
    std::vector<SpirvWords> miss;        // indexed by miss index
    std::vector<SpirvWords> closestHit;  // one for each hit group
    SpirvWords anyHit;                   // shared by all hit groups; empty: there is none
    // The hit group of each record of the table. If empty, all hits use group 0, whatever their record.
    std::vector<std::uint32_t> hitRecords;
};

struct ShaderBindingTable {
    Buffer buffer;
    VkStridedDeviceAddressRegionKHR rayGeneration{};
    VkStridedDeviceAddressRegionKHR miss{};
    VkStridedDeviceAddressRegionKHR hit{};
};

// Error "vulkan-call".
Result<UniquePipeline> createRayPipeline(Context::State& context, VkPipelineLayout layout,
                                         const RayPipelineSource& source, PipelineCreation& creation);

// Makes the table of a pipeline that was made from the same source. Commands that are submitted afterwards
// see it. `pool` must outlive the result. Errors: those of buffers, "vulkan-call".
Result<ShaderBindingTable> createTable(Context::State& context, MemoryPool& pool, VkPipeline pipeline,
                                       const RayPipelineSource& source);

// A hash of everything that a pipeline is made from, except its layout and flags: its stages' SPIR-V and the
// size of its workgroups. 128 bits, so that two pipelines of a program never share one by chance.
struct PipelineIdentity {
    std::uint64_t low = 0;
    std::uint64_t high = 0;

    friend bool operator<(const PipelineIdentity& a, const PipelineIdentity& b) {
        return std::tie(a.low, a.high) < std::tie(b.low, b.high);
    }
};

// `stages` are the words of each stage in its order, of modules of the package; `number` tells pipelines with
// the same stages apart.
PipelineIdentity identify(const Package& package, VkPipelineBindPoint point, std::uint64_t number,
                          const std::vector<std::span<const std::uint32_t>>& stages);

// The records of the shader binding table do not count, because they are no part of the pipeline.
PipelineIdentity identify(const Package& package, const RayPipelineSource& source);

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

Result<MadePipeline> makePipeline(const PipelineJob& job, VkPipelineCreateFlags flags);

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

// Requires DeviceHandles::pipelineStatistics and a pipeline that was made with
// VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR. Error "vulkan-call".
Result<std::vector<Renderer::PipelineStatistics::Executable>> readExecutables(const Context::State& context,
                                                                              VkPipeline pipeline);

// Returns the way in which the pipeline was made, without its executables.
Renderer::PipelineStatistics describe(const MadePipeline& pipeline);

// --- The ordering tile-sort ---

// Returns whether the device has enough shared memory, threads and subgroups for tile-sort.
bool sortsTiles(const DeviceLimits& limits);

// Returns the number of threads in a workgroup of the copy pass.
std::uint32_t tileSortThreads(const DeviceLimits& limits, std::uint32_t bucketCount);

// Returns PipelineCreation::threads of a module. It is 0 for every module except that of the copy pass.
std::uint32_t chosenThreads(const DeviceLimits& limits, const package::ModuleKey& key,
                            std::uint32_t bucketCount);

// The numbers of workgroups of the passes, which share the hits out among themselves. They are as many as run
// at once, but no more than `maxHits` keep busy.
struct TileSortGroups {
    std::uint32_t count = 1;
    std::uint32_t copy = 1;
};
TileSortGroups tileSortGroups(const DeviceLimits& limits, std::uint32_t bucketCount, std::uint64_t maxHits);

}  // namespace glint
