#version 460
// Ordering, last pass: writes each hit's index into the next free slot of its bucket.
#define GLINT_BUCKET_WORDS bucketCursors
#define GLINT_HITS_NUMBERED 1
#include "order/bucket_key.glsl"
#include "hit/list.glsl"
#include "order/ordering.glsl"

layout(local_size_x = kRayGroupSize) in;

void main() {
    uint index = listIndex();
    bool hasHit = index < GLINT_FRAME.rayDispatch.data[0].elementCount;
    uint bucket = hasHit ? storedKey(index) : kNoGroup;
    uint number = addHit(bucket);
    if (hasHit) {
        GLINT_FRAME.orderedHits.data[GLINT_FRAME.bucketBegins.data[bucket] + number] = index;
    }
}
