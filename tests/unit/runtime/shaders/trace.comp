#version 460
#extension GL_GOOGLE_include_directive : require
#include "common.glsl"
#include "trace.glsl"

layout(local_size_x = kRayGroupSize) in;

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index < FRAME.rayDispatch.data[0].elementCount) {
        FRAME.hits.data[index] = traceRay(FRAME.listed.data[index]);
    }
}
