#version 460
#extension GL_GOOGLE_include_directive : require
#include "common.glsl"
#include "images.glsl"
#include "trace.glsl"

layout(local_size_x = kRayGroupSize) in;

void main() {
    BucketRecord bucket = FRAME.buckets.data[pushed.bucket];
    if (gl_GlobalInvocationID.x < bucket.count) {
        HitRecord hit = FRAME.hits.data[FRAME.orderedHits.data[bucket.begin + gl_GlobalInvocationID.x]];
        FRAME.radiance.data[hit.target] = describe(hit);
    }
}
