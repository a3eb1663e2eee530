#version 460
// First pass of the ordering tile-sort: the number of hits in each bucket. Each workgroup counts many hits in shared
// memory and adds what it has once. The last to finish scans the counts of all, which spares a pass.
#include "hit/bucket_scan.glsl"
#include "hit/tile_sort.glsl"

layout(local_size_x = kTileGroupSize) in;

shared uint counters[kCounters];
shared bool isLast;

void clearCounters() {
    for (uint i = gl_LocalInvocationIndex; i < kCounters; i += kTileGroupSize) {
        counters[i] = 0u;
    }
}

void countKeys() {
    uint rays = GLINT_FRAME.rayDispatch.data[kDispatchRays].elementCount;
    uint vectors = (rays + kKeysOfVector - 1u) / kKeysOfVector;
    uint stride = gl_NumWorkGroups.x * kTileGroupSize;
    for (uint i = gl_WorkGroupID.x * kTileGroupSize + gl_LocalInvocationIndex; i < vectors; i += stride) {
        uvec4 keys = GLINT_FRAME.bucketKeys.data[i];
        uint count = min(rays - i * kKeysOfVector, kKeysOfVector);
        [[unroll]] for (uint k = 0u; k < kKeysOfVector; ++k) {
            if (k < count) {
                atomicAdd(counters[localCounter(keyOf(keys, k), gl_LocalInvocationIndex)], 1u);
            }
        }
    }
}

void addCounters() {
    for (uint bucket = gl_LocalInvocationIndex; bucket < kLocalBuckets; bucket += kTileGroupSize) {
        uint sum = 0u;
        for (uint copy = 0u; copy < kCopies; ++copy) {
            // Neighbours begin at different copies, which lie in different banks.
            sum += counters[localCounter(bucket, copy + bucket)];
        }
        if (sum > 0u) {
            atomicAdd(GLINT_FRAME.bucketCounts.data[bucket], sum);
        }
    }
}

// Whether all other workgroups have added what they have.
bool finishesLast() {
    memoryBarrierBuffer();
    barrier();
    if (gl_LocalInvocationIndex == 0u) {
        isLast = atomicAdd(GLINT_FRAME.bucketCounts.data[kBuckets], 1u) == gl_NumWorkGroups.x - 1u;
    }
    barrier();
    memoryBarrierBuffer();
    return isLast;
}

void main() {
    clearCounters();
    barrier();
    countKeys();
    barrier();
    addCounters();
    if (finishesLast()) {
        scanBuckets();
    }
}
