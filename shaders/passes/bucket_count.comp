#version 460
// Ordering, first pass: the number of hits in each bucket.
#define GLINT_BUCKET_WORD count
#define GLINT_HITS_NUMBERED 0
#include "hit/list.glsl"
#include "hit/ordering.glsl"
#include "hit/record.glsl"

layout(local_size_x = kRayGroupSize) in;

void main() {
    uint index = listIndex();
    addHit(index < GLINT_FRAME.rayDispatch.data[0].elementCount ? bucketOf(index) : kNoBucket);
}
