// The description of a bottom level in Vulkan's terms.
#pragma once

#include "scene/acceleration.h"

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

}  // namespace glint
