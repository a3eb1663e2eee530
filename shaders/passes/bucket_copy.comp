#version 460
// Ordering, third pass: each hit's index into the next free slot of its bucket.
#include "hit/list.glsl"
#include "hit/record.glsl"

layout(local_size_x = kRayGroupSize) in;

void main() {
    uint index = listIndex();
    if (index < GLINT_FRAME.rayDispatch.data[0].elementCount) {
        uint bucket = bucketOf(index);
        uint slot = atomicAdd(GLINT_FRAME.buckets.data[bucket].cursor, 1u);
        GLINT_FRAME.orderedHits.data[slot] = index;
    }
}
