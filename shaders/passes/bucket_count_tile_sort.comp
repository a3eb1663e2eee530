#version 460
// First pass of the ordering tile-sort: the number of hits in each bucket. Each workgroup counts many hits in shared
// memory and adds what it has once. The last to finish scans the counts of all, which spares a pass.
#extension GL_EXT_control_flow_attributes : require

#define GLINT_SCAN_GROUP_SIZE kCountGroupSize
#include "hit/bucket_scan.glsl"
#include "hit/tile_sort.glsl"

layout(local_size_x = kCountGroupSize) in;

// A bucket has several counters, and neighbouring threads add to different ones: hits of one bucket, which neighbours
// mostly are, do not wait for each other.
const uint kCopies = min(2048u / kLocalBuckets, 32u);
const uint kCounters = kLocalBuckets * kCopies;

shared uint counters[kCounters];
shared bool isLast;

void clearCounters() {
    for (uint i = gl_LocalInvocationIndex; i < kCounters; i += kCountGroupSize) {
        counters[i] = 0u;
    }
}

void countKeys(uvec4 keys, uint count) {
    uint copy = gl_LocalInvocationIndex % kCopies;
    if (count >= kKeysOfVector) {
        [[unroll]] for (uint k = 0u; k < kKeysOfVector; ++k) {
            atomicAdd(counters[keyOf(keys, k) * kCopies + copy], 1u);
        }
    } else {
        for (uint k = 0u; k < count; ++k) {
            atomicAdd(counters[keyOf(keys, k) * kCopies + copy], 1u);
        }
    }
}

void countAllKeys() {
    uint rays = GLINT_FRAME.rayDispatch.data[kDispatchRays].elementCount;
    KeyArray list = GLINT_FRAME.bucketKeys;
    uint vectors = (rays + kKeysOfVector - 1u) / kKeysOfVector;
    uint stride = gl_NumWorkGroups.x * kCountGroupSize;
    uint i = gl_WorkGroupID.x * kCountGroupSize + gl_LocalInvocationIndex;
    // Two vectors on their way at once.
    for (; i + stride < vectors; i += 2u * stride) {
        uvec4 keys = list.data[i];
        uvec4 next = list.data[i + stride];
        countKeys(keys, rays - i * kKeysOfVector);
        countKeys(next, rays - (i + stride) * kKeysOfVector);
    }
    if (i < vectors) {
        countKeys(list.data[i], rays - i * kKeysOfVector);
    }
}

void addCounters() {
    for (uint bucket = gl_LocalInvocationIndex; bucket < kLocalBuckets; bucket += kCountGroupSize) {
        uint sum = 0u;
        for (uint copy = 0u; copy < kCopies; ++copy) {
            // Neighbours begin at different copies, which lie in different banks.
            sum += counters[bucket * kCopies + (copy + bucket) % kCopies];
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
    countAllKeys();
    barrier();
    addCounters();
    if (finishesLast()) {
        scanBuckets();
    }
}
