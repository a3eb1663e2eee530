#version 460
// Indirect arguments for the passes over the ray list.
#include "hit/list.glsl"

layout(local_size_x = 1) in;

void main() {
#if GLINT_STEPS
    if (isHostsList()) {
        GLINT_FRAME.counters.data[kCounterRays] = min(GLINT_FRAME.rayCount.data[0], GLINT_FRAME.width);
    }
#endif
    uint count = GLINT_FRAME.counters.data[kCounterRays];
    GLINT_FRAME.rayDispatch.data[0] = listDispatch(count, kRayGroupSize);
#if GLINT_PATHS
    // A bounce has many rays if more than one in kFewRays pixels sends one: the host records these in any case, and
    // further ones at random. Twice as much of the light of so few pixels is little noise.
    const uint kFewRays = 1024u;
    if (count > GLINT_FRAME.width * (GLINT_FRAME.endRow - GLINT_FRAME.firstRow) / kFewRays) {
        uint deepest = GLINT_FRAME.counters.data[kCounterDeepest];
        GLINT_FRAME.counters.data[kCounterDeepest] = max(deepest, GLINT_FRAME.bounce);
    }
#endif
}
