#version 460
// Checks the order of the hits on the device: each slot of a bucket holds a hit of that bucket.
#include "hit/list.glsl"
#include "hit/record.glsl"

GLINT_RAY_WORKGROUP

void main() {
    uint index = listIndex();
    if (index >= GLINT_FRAME.rayDispatch.data[0].elementCount) {
        return;
    }
    BucketRecord bucket = GLINT_FRAME.buckets.data[bucketOf(index)];
    uint found = 0u;
    for (uint slot = bucket.begin; slot < bucket.begin + bucket.count; ++slot) {
        found += GLINT_FRAME.orderedHits.data[slot] == index ? 1u : 0u;
    }
    if (found != 1u || bucket.cursor != bucket.begin + bucket.count) {
        atomicAdd(GLINT_FRAME.counters.data[kCounterOrderErrors], 1u);
    }
}
