// The properties of the ordering tile-sort that depend on the device.
#pragma once

#include "context/context.h"

#include <glint/package_modules.h>

#include <cstdint>

namespace glint {

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
