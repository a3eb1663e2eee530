#version 460
// The first pass of the ordering tile-sort: counts the hits in each bucket. Each workgroup counts many hits in shared
// memory and adds its counts once.
#extension GL_EXT_control_flow_attributes : require

#include "order/tile_sort.glsl"

layout(local_size_x = kCountGroupSize) in;

// A bucket has several counters, and neighbouring threads add to different ones. Neighbours mostly have hits of one
// bucket, and so they do not wait for each other.
const uint kCopies = min(2048u / kLocalBuckets, 32u);
const uint kCounters = kLocalBuckets * kCopies;

shared uint counters[kCounters];

void clearCounters() {
    for (uint i = gl_LocalInvocationIndex; i < kCounters; i += kCountGroupSize) {
        counters[i] = 0u;
    }
}

void countKey(uint key) {
    atomicAdd(counters[key * kCopies + gl_LocalInvocationIndex % kCopies], 1u);
}

// The next vector is loaded while this one is counted.
void countKeys(KeyArray list, uint rays) {
    uint vectors = rays / kKeysOfVector;
    uint stride = gl_NumWorkGroups.x * kCountGroupSize;
    uint i = gl_WorkGroupID.x * kCountGroupSize + gl_LocalInvocationIndex;
    uvec4 keys = i < vectors ? list.data[i] : uvec4(0u);
    while (i < vectors) {
        i += stride;
        uvec4 next = i < vectors ? list.data[i] : uvec4(0u);
        [[unroll]] for (uint k = 0u; k < kKeysOfVector; ++k) {
            countKey(keyOf(keys, k));
        }
        keys = next;
    }
}

// Counts the keys behind the last whole vector.
void countRest(KeyArray list, uint rays) {
    uint vectors = rays / kKeysOfVector;
    if (gl_WorkGroupID.x == 0u && gl_LocalInvocationIndex < rays % kKeysOfVector) {
        countKey(keyOf(list.data[vectors], gl_LocalInvocationIndex));
    }
}

void addCounters(CounterArray counts) {
    for (uint bucket = gl_LocalInvocationIndex; bucket < kLocalBuckets; bucket += kCountGroupSize) {
        uint sum = 0u;
        for (uint copy = 0u; copy < kCopies; ++copy) {
            // Neighbours begin at different copies, which lie in different banks.
            sum += counters[bucket * kCopies + (copy + bucket) % kCopies];
        }
        if (sum > 0u) {
            atomicAdd(counts.data[bucket], sum);
        }
    }
}

void main() {
    // These addresses are read once: for all that a compiler knows, later writes may change the constants, so it would
    // read them again.
    uint rays = GLINT_FRAME.rayDispatch.data[0].elementCount;
    KeyArray list = GLINT_FRAME.bucketKeys;
    CounterArray counts = GLINT_FRAME.bucketCounts;
    clearCounters();
    barrier();
    countKeys(list, rays);
    countRest(list, rays);
    barrier();
    addCounters(counts);
}
