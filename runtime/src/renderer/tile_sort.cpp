#include "renderer/tile_sort.h"

#include "interop/frame.h"

#include <algorithm>

namespace glint {
namespace {

// The number for devices that do not report theirs. It is between those of a small GPU and of a large one.
constexpr std::uint32_t kGuessedMultiprocessors = 64;

// The number of workgroups that a multiprocessor runs at once, given the shared memory of an H200:
// docs/performance.md.
constexpr std::uint32_t kCountGroups = 2;
constexpr std::uint32_t kSmallCopyGroups = 3;
constexpr std::uint32_t kCopyGroups = 2;
constexpr std::uint32_t kLargeCopyGroups = 1;

// Scans need subgroups of at least this size: they have a word of shared memory for every fourth thread.
constexpr std::uint32_t kLeastSubgroup = 4;

std::uint32_t groupsFor(std::uint64_t hits, std::uint32_t hitsOfGroup, std::uint32_t atOnce) {
    return static_cast<std::uint32_t>(
        std::clamp<std::uint64_t>((hits + hitsOfGroup - 1) / hitsOfGroup, 1, atOnce));
}

}  // namespace

bool sortsTiles(const DeviceLimits& limits) {
    constexpr std::uint32_t kThreads = std::max(gpu::kTileThreads, gpu::kCountGroupSize);
    return limits.core.maxComputeSharedMemorySize >= gpu::kTileSharedBytes &&
           limits.core.maxComputeWorkGroupInvocations >= kThreads &&
           limits.core.maxComputeWorkGroupSize[0] >= kThreads && limits.subgroupSize >= kLeastSubgroup &&
           gpu::kSmallTileThreads % limits.subgroupSize == 0 &&
           (limits.subgroupOperations & VK_SUBGROUP_FEATURE_SHUFFLE_RELATIVE_BIT) != 0;
}

std::uint32_t tileSortThreads(const DeviceLimits& limits, std::uint32_t bucketCount) {
    if (bucketCount <= gpu::kSmallTileBuckets) {
        return gpu::kSmallTileThreads;
    }
    const bool large = bucketCount > gpu::kTileBuckets &&
                       limits.core.maxComputeSharedMemorySize >= gpu::kLargeTileSharedBytes &&
                       limits.core.maxComputeWorkGroupInvocations >= gpu::kLargeTileThreads &&
                       limits.core.maxComputeWorkGroupSize[0] >= gpu::kLargeTileThreads;
    return large ? gpu::kLargeTileThreads : gpu::kTileThreads;
}

std::uint32_t chosenThreads(const DeviceLimits& limits, const package::ModuleKey& key,
                            std::uint32_t bucketCount) {
    constexpr auto kTileSort = static_cast<std::uint32_t>(package::Ordering::TileSort);
    const bool copiesTiles = key.role == package::ModuleRole::BucketCopy && key.index == kTileSort;
    return copiesTiles ? tileSortThreads(limits, bucketCount) : 0;
}

TileSortGroups tileSortGroups(const DeviceLimits& limits, std::uint32_t bucketCount, std::uint64_t maxHits) {
    const std::uint32_t processors =
        limits.multiprocessors > 0 ? limits.multiprocessors : kGuessedMultiprocessors;
    const std::uint32_t threads = tileSortThreads(limits, bucketCount);
    const std::uint32_t copyGroups = threads < gpu::kTileThreads   ? kSmallCopyGroups
                                     : threads > gpu::kTileThreads ? kLargeCopyGroups
                                                                   : kCopyGroups;
    // A thread counts at least four keys at a time, which is the number for keys of four bytes.
    return {groupsFor(maxHits, gpu::kCountGroupSize * 4, processors * kCountGroups),
            groupsFor(maxHits, threads * gpu::kTileHitsOfThread, processors * copyGroups)};
}

}  // namespace glint
