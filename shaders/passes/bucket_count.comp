#version 460
// Ordering, first pass: counts the hits in each bucket.
#define GLINT_BUCKET_WORDS bucketCounts
#define GLINT_HITS_NUMBERED 0
#include "order/bucket_key.glsl"
#include "hit/list.glsl"
#include "order/ordering.glsl"

layout(local_size_x = kRayGroupSize) in;

void main() {
    uint index = listIndex();
    addHit(index < GLINT_FRAME.rayDispatch.data[0].elementCount ? storedKey(index) : kNoGroup);
}
