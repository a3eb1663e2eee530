#version 460
#extension GL_GOOGLE_include_directive : require
#include "common.glsl"
#include "list.glsl"

layout(local_size_x = kRayGroupSize) in;

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index < FRAME.rayDispatch.data[0].elementCount) {
        atomicAdd(FRAME.bucketCounts.data[bucketOf(FRAME.hits.data[index])], 1u);
    }
}
