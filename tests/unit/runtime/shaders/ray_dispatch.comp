#version 460
#extension GL_GOOGLE_include_directive : require
#include "common.glsl"
#include "list.glsl"

layout(local_size_x = 1) in;

void main() {
    FRAME.rayDispatch.data[0] = listDispatch(FRAME.counters.data[kCounterRays]);
}
