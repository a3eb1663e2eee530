// The description of a BLAS in Vulkan's terms.
#pragma once

#include "context/commands.h"
#include "scene/acceleration.h"

#include <span>
#include <vector>

namespace glint {

// An input in Vulkan's terms. `info` points into `geometries`, and these into `micromaps`. Both stay in place
// when a BlasBuild moves, since they are vectors.
struct BlasBuild {
    std::vector<VkAccelerationStructureGeometryKHR> geometries;
    std::vector<VkAccelerationStructureTrianglesOpacityMicromapEXT> micromaps;  // of some geometries
    std::vector<VkAccelerationStructureBuildRangeInfoKHR> ranges;
    VkAccelerationStructureBuildGeometryInfoKHR info{};
    VkDeviceSize structureBytes = 0;
    VkDeviceSize scratchBytes = 0;        // rounded up to the alignment of scratch
    VkDeviceSize updateScratchBytes = 0;  // rounded up too; 0 if it can't be updated
};

// Describes a build except for its destination and its scratch memory.
BlasBuild describeBuild(const Context::State& context, const BlasInput& input);

// Orders builds that share scratch memory, or of which one reads the result of the other.
inline constexpr MemoryDependency kBuildsInOrder{
    VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_BUILD_BIT_KHR,
    VK_ACCESS_2_ACCELERATION_STRUCTURE_WRITE_BIT_KHR,
    VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_BUILD_BIT_KHR,
    VK_ACCESS_2_ACCELERATION_STRUCTURE_READ_BIT_KHR | VK_ACCESS_2_ACCELERATION_STRUCTURE_WRITE_BIT_KHR};

// Builds with destinations that share scratch memory: a build that does not fit beside the earlier ones waits
// for them. No dependency is recorded before the first build or after the last. Requires scratchBytesOf()
// bytes.
struct ScratchRange {
    VkDeviceAddress address = 0;
    VkDeviceSize bytes = 0;
};
void recordBuilds(const Context::State& context, VkCommandBuffer commands,
                  std::span<const BlasBuild* const> builds, const ScratchRange& scratch);
// Returns the size of that memory: as much as all builds need, and at most 64 MiB unless one build needs
// more.
VkDeviceSize scratchBytesOf(const Context::State& context, std::span<const BlasBuild* const> builds);

}  // namespace glint
