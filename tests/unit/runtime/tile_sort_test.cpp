// Tests which workgroups the ordering tile-sort uses on a device.
#include "interop/frame.h"
#include "renderer/pipeline_jobs.h"

#include <gtest/gtest.h>

namespace {

using namespace glint;

constexpr std::uint64_t kManyHits = 1U << 23U;

DeviceLimits limitsOf(std::uint32_t sharedBytes, std::uint32_t threads) {
    DeviceLimits limits;
    limits.core.maxComputeSharedMemorySize = sharedBytes;
    limits.core.maxComputeWorkGroupInvocations = threads;
    limits.core.maxComputeWorkGroupSize[0] = threads;
    limits.subgroupSize = 32;
    limits.subgroupOperations = VK_SUBGROUP_FEATURE_SHUFFLE_RELATIVE_BIT;
    limits.multiprocessors = 10;
    return limits;
}

TEST(TileSort, TakesSharedMemoryThreadsAndShuffles) {
    EXPECT_TRUE(sortsTiles(limitsOf(gpu::kTileSharedBytes, 512)));
    EXPECT_FALSE(sortsTiles(limitsOf(gpu::kTileSharedBytes - 1, 512)));
    EXPECT_FALSE(sortsTiles(limitsOf(gpu::kTileSharedBytes, 511)));
    DeviceLimits limits = limitsOf(gpu::kTileSharedBytes, 512);
    limits.subgroupOperations = 0;
    EXPECT_FALSE(sortsTiles(limits));
    limits = limitsOf(gpu::kTileSharedBytes, 512);
    limits.subgroupSize = 128;  // does not divide 448
    EXPECT_FALSE(sortsTiles(limits));
}

TEST(TileSort, HasLargeTilesForManyBucketsWhereTheDeviceCan) {
    const DeviceLimits large = limitsOf(gpu::kLargeTileSharedBytes, 1024);
    EXPECT_EQ(tileSortThreads(large, gpu::kSmallTileBuckets), gpu::kSmallTileThreads);
    EXPECT_EQ(tileSortThreads(large, gpu::kSmallTileBuckets + 1), gpu::kTileThreads);
    EXPECT_EQ(tileSortThreads(large, gpu::kTileBuckets), gpu::kTileThreads);
    EXPECT_EQ(tileSortThreads(large, gpu::kTileBuckets + 1), gpu::kLargeTileThreads);
    for (const DeviceLimits& limits :
         {limitsOf(gpu::kLargeTileSharedBytes - 1, 1024), limitsOf(gpu::kLargeTileSharedBytes, 1023)}) {
        EXPECT_EQ(tileSortThreads(limits, gpu::kMaxLocalBuckets), gpu::kTileThreads);
    }
}

TEST(TileSort, HasAsManyWorkgroupsAsRunAtOnce) {
    const DeviceLimits limits = limitsOf(gpu::kLargeTileSharedBytes, 1024);
    EXPECT_EQ(tileSortGroups(limits, 64, kManyHits).copy, 30U);
    EXPECT_EQ(tileSortGroups(limits, 256, kManyHits).copy, 20U);
    EXPECT_EQ(tileSortGroups(limits, 1024, kManyHits).copy, 10U);
    EXPECT_EQ(tileSortGroups(limits, 64, kManyHits).count, 20U);
    // If a device does not report its number of multiprocessors, it must not be assumed to have one.
    DeviceLimits unknown = limits;
    unknown.multiprocessors = 0;
    EXPECT_GT(tileSortGroups(unknown, 64, kManyHits).copy, tileSortGroups(limits, 64, kManyHits).copy);
}

TEST(TileSort, HasNoMoreWorkgroupsThanTiles) {
    const DeviceLimits limits = limitsOf(gpu::kLargeTileSharedBytes, 1024);
    constexpr std::uint64_t kTile = std::uint64_t{gpu::kSmallTileThreads} * gpu::kTileHitsOfThread;
    for (const auto& [hits, groups] :
         {std::pair{std::uint64_t{0}, 1U}, {1, 1U}, {kTile, 1U}, {kTile + 1, 2U}}) {
        EXPECT_EQ(tileSortGroups(limits, 2, hits).copy, groups) << hits;
    }
}

}  // namespace
