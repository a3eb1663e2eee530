#version 460
// Ordering, third pass: each hit's index into the next free slot of its bucket.
#define GLINT_BUCKET_WORD cursor
#define GLINT_HITS_NUMBERED 1
#include "hit/list.glsl"
#include "hit/ordering.glsl"
#include "hit/record.glsl"

layout(local_size_x = kRayGroupSize) in;

void main() {
    uint index = listIndex();
    bool hasHit = index < GLINT_FRAME.rayDispatch.data[0].elementCount;
    uint slot = addHit(hasHit ? bucketOf(index) : kNoBucket);
    if (hasHit) {
        GLINT_FRAME.orderedHits.data[slot] = index;
    }
}
