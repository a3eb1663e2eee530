#version 460
// Traces the deferred shadow rays of hits. Light that nothing blocks is added to the results of their samples.
#include "hit/count.glsl"
#include "light/ray.glsl"
#include "hit/list.glsl"
#include "hit/samples.glsl"

GLINT_RAY_WORKGROUP

void main() {
    uint index = listIndex();
    if (index >= GLINT_FRAME.shadowDispatch.data[0].elementCount) {
        return;
    }
    ShadowRecord shadow = GLINT_FRAME.shadows.data[index];
#if GLINT_TALLIES
    tallyForSample(shadow.target);
#endif
    GLINT_CLOCK_START
    bool visible = lightArrivesTo(shadow.sees, shadow.origin, shadow.direction, shadow.distance, shadow.light);
    countRays(kEffectShadow, 1u, visible ? 1u : 0u);
    if (visible) {
        addRadiance(shadow.target, shadow.light);
    }
    GLINT_CLOCK_STOP
}
