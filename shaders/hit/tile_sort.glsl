// What both passes of the ordering tile-sort share: counters in shared memory.
//
// A bucket has several counters, and neighbouring lanes add to different ones: hits of one bucket, which neighbours
// mostly are, do not wait for each other.
#extension GL_EXT_control_flow_attributes : require

#include "hit/bucket_key.glsl"

// Renderers refuse this ordering where there are more buckets than kMaxLocalBuckets.
#if GLINT_CASE_COUNT < 128
const uint kCopies = 32u;
#elif GLINT_CASE_COUNT < 256
const uint kCopies = 16u;
#elif GLINT_CASE_COUNT < 512
const uint kCopies = 8u;
#else
const uint kCopies = 4u;
#endif

const uint kLocalBuckets = min(kBuckets, kMaxLocalBuckets);
const uint kCounters = kLocalBuckets * kCopies;
const uint kCountersOfThread = (kCounters + kTileGroupSize - 1u) / kTileGroupSize;

// A tile's keys: whole vectors of each thread. Tiles are longer where there are more buckets, as runs get shorter.
const uint kVectorsOfThread = kKeyBytes == 1u ? 1u : 3u;
const uint kKeysOfThread = kVectorsOfThread * kKeysOfVector;
const uint kTileHits = kKeysOfThread * kTileGroupSize;  // at most kMaxTileHits

// The counter that a lane adds to.
uint localCounter(uint bucket, uint lane) {
    return bucket * kCopies + lane % kCopies;
}
