#version 460
#extension GL_GOOGLE_include_directive : require
#include "common.glsl"
#include "images.glsl"
#include "trace.glsl"

layout(local_size_x = kRayGroupSize) in;

void main() {
    if (gl_GlobalInvocationID.x < FRAME.bucketCounts.data[pushed.bucket]) {
        uint index = FRAME.orderedHits.data[FRAME.bucketBegins.data[pushed.bucket] + gl_GlobalInvocationID.x];
        FRAME.sampleStarts.data[FRAME.listed.data[index]] = describe(FRAME.hits.data[index]);
    }
}
