// Ray tracing pipelines with their shader binding tables.
#pragma once

#include "resources.h"

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

struct RayPipeline {
    UniquePipeline pipeline;
    ShaderBindingTable table;
};

// Waits until the table is on the device. `pool` must outlive the result. Errors: those of buffers and
// submissions, "vulkan-call".
Result<RayPipeline> createRayPipeline(Context::State& context, MemoryPool& pool, VkPipelineLayout layout,
                                      const RayPipelineSource& source);

}  // namespace glint
