#version 460
// Indirect arguments for the pass over the list of shadow rays.
#include "hit/list.glsl"

layout(local_size_x = 1) in;

void main() {
    GLINT_FRAME.shadowDispatch.data[0] = listDispatch(GLINT_FRAME.counters.data[kCounterShadowRays], kRayGroupSize);
}
