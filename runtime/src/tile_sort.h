// The ordering tile-sort, as far as the device decides on it.
#pragma once

#include "context_state.h"

#include <glint/package_modules.h>

#include <cstdint>

namespace glint {

// Whether the device has the shared memory, threads and subgroups that it takes.
bool sortsTiles(const DeviceLimits& limits);

// Threads of a workgroup of its copy pass.
std::uint32_t tileSortThreads(const DeviceLimits& limits, std::uint32_t bucketCount);

// PipelineCreation::threads of a module: of that pass; 0 of all others.
std::uint32_t chosenThreads(const DeviceLimits& limits, const package::ModuleKey& key,
                            std::uint32_t bucketCount);

// Workgroups of its passes: as many as run at once, which share the hits out among them, and no more than
// `maxHits` keep busy.
struct TileSortGroups {
    std::uint32_t count = 1;
    std::uint32_t copy = 1;
};
TileSortGroups tileSortGroups(const DeviceLimits& limits, std::uint32_t bucketCount, std::uint64_t maxHits);

}  // namespace glint
