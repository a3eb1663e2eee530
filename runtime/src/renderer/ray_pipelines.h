// Ray tracing pipelines with their shader binding tables.
#pragma once

#include "context/resources.h"
#include "package/shader_modules.h"

#include <cstdint>
#include <span>
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

}  // namespace glint
