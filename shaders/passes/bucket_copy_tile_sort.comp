#version 460
// Last pass of the ordering tile-sort. A workgroup sorts a tile of hits in shared memory, takes room in each bucket that
// the tile has by one atomic, and writes whole runs of a bucket side by side.
//
// The counters of a tile, scanned in the order of buckets and then of copies, are where hits go in the sorted tile
// (Satish, Harris and Garland, "Designing efficient sorting algorithms for manycore GPUs", 2009).
#include "hit/bucket_scan.glsl"
#include "hit/tile_sort.glsl"

layout(local_size_x = kTileGroupSize) in;

// One word in 33 is left out, so that neither neighbouring counters nor those of neighbouring threads share a bank.
uint padded(uint counter) {
    return counter + counter / 32u;
}

const uint kPaddedCounters = kCountersOfThread * kTileGroupSize * 33u / 32u;

shared uint tile[max(kPaddedCounters, kTileHits)];  // counters; later the sorted hits
shared uint slotOffsets[kLocalBuckets];             // from a place in the sorted tile to the slot, by bucket

void clearCounters() {
    [[unroll]] for (uint i = 0u; i < kCountersOfThread; ++i) {
        tile[padded(i * kTileGroupSize + gl_LocalInvocationIndex)] = 0u;
    }
}

// From the number of hits of each counter to where they begin in the sorted tile.
void scanCounters() {
    uint first = scanThread() * kCountersOfThread;
    uint sum = 0u;
    [[unroll]] for (uint i = 0u; i < kCountersOfThread; ++i) {
        sum += tile[padded(first + i)];
    }
    uint total;
    uint begin = scanWorkgroup(sum, total);
    [[unroll]] for (uint i = 0u; i < kCountersOfThread; ++i) {
        uint count = tile[padded(first + i)];
        tile[padded(first + i)] = begin;
        begin += count;
    }
}

// Takes slots of every bucket for the tile's hits.
void takeSlots(uint hits) {
    for (uint bucket = gl_LocalInvocationIndex; bucket < kLocalBuckets; bucket += kTileGroupSize) {
        uint begin = tile[padded(bucket * kCopies)];
        uint end = bucket + 1u < kLocalBuckets ? tile[padded((bucket + 1u) * kCopies)] : hits;
        if (end > begin) {
            slotOffsets[bucket] = atomicAdd(GLINT_FRAME.bucketCursors.data[bucket], end - begin) - begin;
        }
    }
}

void main() {
    uint rays = GLINT_FRAME.rayDispatch.data[kDispatchRays].elementCount;
    uint first = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * kTileHits;
    if (first >= rays) {
        return;
    }
    uint hits = min(rays - first, kTileHits);
    uint firstOfThread = gl_LocalInvocationIndex * kKeysOfThread;
    uvec4 keys[kVectorsOfThread];
    [[unroll]] for (uint i = 0u; i < kVectorsOfThread; ++i) {
        keys[i] = GLINT_FRAME.bucketKeys.data[(first + firstOfThread) / kKeysOfVector + i];
    }
    clearCounters();
    barrier();
    uint ranks[kKeysOfThread];
    [[unroll]] for (uint k = 0u; k < kKeysOfThread; ++k) {
        uint bucket = keyOf(keys[k / kKeysOfVector], k % kKeysOfVector);
        ranks[k] = 0u;
        if (firstOfThread + k < hits) {
            ranks[k] = atomicAdd(tile[padded(localCounter(bucket, gl_LocalInvocationIndex))], 1u);
        }
    }
    barrier();
    scanCounters();
    barrier();
    takeSlots(hits);
    [[unroll]] for (uint k = 0u; k < kKeysOfThread; ++k) {
        if (firstOfThread + k < hits) {
            uint bucket = keyOf(keys[k / kKeysOfVector], k % kKeysOfVector);
            ranks[k] += tile[padded(localCounter(bucket, gl_LocalInvocationIndex))];
        }
    }
    barrier();
    [[unroll]] for (uint k = 0u; k < kKeysOfThread; ++k) {
        if (firstOfThread + k < hits) {
            uint bucket = keyOf(keys[k / kKeysOfVector], k % kKeysOfVector);
            tile[ranks[k]] = bucket << 16 | (firstOfThread + k);
        }
    }
    barrier();
    for (uint i = gl_LocalInvocationIndex; i < hits; i += kTileGroupSize) {
        uint hit = tile[i];
        GLINT_FRAME.orderedHits.data[slotOffsets[hit >> 16] + i] = first + (hit & 0xFFFFu);
    }
}
