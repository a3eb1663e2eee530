// Ray tracing pipelines with their shader binding tables.
#pragma once

#include "resources.h"
#include "shader_modules.h"

#include <cstdint>
#include <span>
#include <vector>

namespace glint {

using SpirvWords = std::span<const std::uint32_t>;

// What a pipeline and its table are made of. Rays of its ray generation shaders do not recurse.
struct RayPipelineSource {
    std::vector<SpirvWords> rayGeneration;  // a pass each
    std::vector<SpirvWords> miss;           // by miss index
    std::vector<SpirvWords> closestHit;     // a hit group each
    SpirvWords anyHit;                      // of every hit group; empty: none
    // Hit group of each record of the table; empty: all hits, whatever their record, are of group 0.
    std::vector<std::uint32_t> hitRecords;
};

struct ShaderBindingTable {
    Buffer buffer;
    std::vector<VkStridedDeviceAddressRegionKHR> rayGeneration;  // as in the source
    VkStridedDeviceAddressRegionKHR miss{};
    VkStridedDeviceAddressRegionKHR hit{};
};

// Error "vulkan-call".
Result<UniquePipeline> createRayPipeline(Context::State& context, VkPipelineLayout layout,
                                         const RayPipelineSource& source, PipelineCreation& creation);

// The table of a pipeline that was made of the same source. Waits until it is on the device. `pool` must
// outlive the result. Errors: those of buffers and submissions, "vulkan-call".
Result<ShaderBindingTable> createTable(Context::State& context, MemoryPool& pool, VkPipeline pipeline,
                                       const RayPipelineSource& source);

}  // namespace glint
