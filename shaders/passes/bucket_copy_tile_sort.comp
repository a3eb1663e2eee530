#version 460
// Last pass of the ordering tile-sort. A workgroup sorts a tile of hits in shared memory, takes room in each bucket that
// the tile has by one atomic, and writes whole runs of a bucket side by side.
//
// The counters of a tile, scanned in the order of buckets and then of copies, are where hits go in the sorted tile
// (Satish, Harris and Garland, "Designing efficient sorting algorithms for manycore GPUs", 2009).
#extension GL_EXT_control_flow_attributes : require

#define GLINT_SCAN_GROUP_SIZE GLINT_TILE_GROUP_SIZE
#include "hit/tile_sort.glsl"
#include "hit/bucket_scan.glsl"

const uint kThreads = GLINT_TILE_GROUP_SIZE;

layout(local_size_x = kThreads) in;

// Of a bucket, so that neighbours with hits of the same one do not wait for each other: an atomic that returns takes its
// turn. Few, as they have to be scanned.
const uint kCopies = clamp(1024u / kLocalBuckets, 1u, 8u);
// Counters of a bucket, and one that is left out, so that those of neighbouring buckets lie in different banks.
const uint kStride = kCopies > 1u ? kCopies + 1u : 1u;
// A bucket more, of what is not in the list: behind all hits.
const uint kCounters = (kLocalBuckets + 1u) * kStride;
// Odd, so that threads that scan their own read from different banks.
const uint kCountersOfThread = (kCounters + kThreads - 1u) / kThreads | 1u;

shared uint tile[max(kCountersOfThread * kThreads, kTileHits)];  // counters; later the sorted hits
shared uint slotOffsets[kLocalBuckets];                          // from a place in the sorted tile to the slot, by bucket

// Place of a hit in the sorted tile. Hits of one bucket come from each copy in turn, a power of two apart: they are
// spread over the banks.
uint sortedPlace(uint place) {
    return place ^ (place >> 7 & 31u);
}

// Takes slots of every bucket for the tile's hits.
void takeSlots(CounterArray cursors) {
    for (uint bucket = gl_LocalInvocationIndex; bucket < kLocalBuckets; bucket += kThreads) {
        uint begin = tile[bucket * kStride];
        uint end = tile[(bucket + 1u) * kStride];
        if (end > begin) {
            slotOffsets[bucket] = atomicAdd(cursors.data[bucket], end - begin) - begin;
        }
    }
}

// From the number of hits of each counter to where they begin in the sorted tile.
void scanCounters() {
    uint first = scanThread() * kCountersOfThread;
    uint sum = 0u;
    [[unroll]] for (uint i = 0u; i < kCountersOfThread; ++i) {
        sum += tile[first + i];
    }
    uint total;
    uint begin = scanWorkgroup(sum, total);
    [[unroll]] for (uint i = 0u; i < kCountersOfThread; ++i) {
        uint count = tile[first + i];
        tile[first + i] = begin;
        begin += count;
    }
}

void main() {
    uint rays = GLINT_FRAME.rayDispatch.data[kDispatchRays].elementCount;
    // What is written may be the constants, as far as a compiler knows: read once, an address is not read anew.
    OrderedArray slots = GLINT_FRAME.orderedHits;
    CounterArray cursors = GLINT_FRAME.bucketCursors;
    uint first = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * kTileHits;
    if (first >= rays) {
        return;
    }
    uint hits = min(rays - first, kTileHits);
    uint firstOfThread = gl_LocalInvocationIndex * kKeysOfVector;
    uvec4 keys = GLINT_FRAME.bucketKeys.data[(first + firstOfThread) / kKeysOfVector];
    [[unroll]] for (uint i = 0u; i < kCountersOfThread; ++i) {
        tile[i * kThreads + gl_LocalInvocationIndex] = 0u;
    }
    // In the upper half the bucket of a hit; in the lower its number among those of its counter, then its place in the
    // sorted tile. In one word, as what a thread has in registers decides how many threads run at once.
    uint sorted[kKeysOfVector];
    [[unroll]] for (uint k = 0u; k < kKeysOfVector; ++k) {
        sorted[k] = keyOf(keys, k) << 16;
    }
    if (hits < kTileHits) {
        [[unroll]] for (uint k = 0u; k < kKeysOfVector; ++k) {
            sorted[k] = firstOfThread + k < hits ? sorted[k] : kLocalBuckets << 16;
        }
    }
    barrier();
    uint copy = gl_LocalInvocationIndex % kCopies;
    [[unroll]] for (uint k = 0u; k < kKeysOfVector; ++k) {
        sorted[k] |= atomicAdd(tile[(sorted[k] >> 16) * kStride + copy], 1u);
    }
    barrier();
    scanCounters();
    barrier();
    takeSlots(cursors);
    [[unroll]] for (uint k = 0u; k < kKeysOfVector; ++k) {
        sorted[k] += tile[(sorted[k] >> 16) * kStride + copy];
    }
    barrier();
    [[unroll]] for (uint k = 0u; k < kKeysOfVector; ++k) {
        tile[sortedPlace(sorted[k] & 0xFFFFu)] = (sorted[k] & 0xFFFF0000u) | (firstOfThread + k);
    }
    barrier();
    for (uint place = gl_LocalInvocationIndex; place < hits; place += kThreads) {
        uint hit = tile[sortedPlace(place)];
        slots.data[slotOffsets[hit >> 16] + place] = first + (hit & 0xFFFFu);
    }
}
