#version 460
// Ordering, first pass: the number of hits in each bucket.
#include "hit/list.glsl"
#include "hit/record.glsl"

layout(local_size_x = kRayGroupSize) in;

void main() {
    uint index = listIndex();
    if (index < GLINT_FRAME.rayDispatch.data[0].elementCount) {
        atomicAdd(GLINT_FRAME.buckets.data[bucketOf(index)].count, 1u);
    }
}
