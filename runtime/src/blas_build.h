// A bottom level in Vulkan's terms.
#pragma once

#include "acceleration.h"

#include <vector>

namespace glint {

// An input in Vulkan's terms. `info` points into `geometries`: vectors keep that when a Blas moves.
struct BlasBuild {
    std::vector<VkAccelerationStructureGeometryKHR> geometries;
    std::vector<VkAccelerationStructureBuildRangeInfoKHR> ranges;
    VkAccelerationStructureBuildGeometryInfoKHR info{};
    VkDeviceSize structureBytes = 0;
    VkDeviceSize scratchBytes = 0;        // rounded up to the alignment of scratch
    VkDeviceSize updateScratchBytes = 0;  // likewise; 0 where it can't be updated
};

// Everything but where it is built and with which scratch.
BlasBuild describeBuild(const Context::State& context, const BlasInput& input);

}  // namespace glint
