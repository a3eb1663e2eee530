#version 460
#extension GL_GOOGLE_include_directive : require
#include "common.glsl"
#include "images.glsl"
#include "trace.glsl"

layout(local_size_x = kRayGroupSize) in;

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index < FRAME.rayDispatch.data[0].elementCount) {
        uint target = FRAME.listed.data[index];
        FRAME.sampleStarts.data[target] = describe(traceRay(target));
    }
}
