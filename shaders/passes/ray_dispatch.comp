#version 460
// Indirect arguments for the passes over the ray list.
#include "hit/list.glsl"

layout(local_size_x = 1) in;

void main() {
    GLINT_FRAME.rayDispatch.data[0] = listDispatch(GLINT_FRAME.counters.data[kCounterRays], kRayGroupSize);
}
