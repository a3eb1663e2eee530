#version 460
// Traces the deferred shadow rays of hits. Light that nothing blocks is added to the results of their samples.
#include "hit/count.glsl"
#include "light/ray.glsl"
#include "hit/list.glsl"

GLINT_RAY_WORKGROUP

void main() {
    uint index = listIndex();
    if (index >= GLINT_FRAME.shadowDispatch.data[0].elementCount) {
        return;
    }
    ShadowRecord shadow = GLINT_FRAME.shadows.data[index];
    bool visible = lightArrivesTo(shadow.sees, shadow.origin, shadow.direction, shadow.distance, shadow.light);
    countRays(kEffectShadow, 1u, visible ? 1u : 0u);
    if (visible) {
        // A sample has one ray, and its hit has one shadow ray, so no other thread writes here.
        vec4 radiance = GLINT_FRAME.radiance.data[shadow.target];
        GLINT_FRAME.radiance.data[shadow.target] = vec4(radiance.rgb + shadow.light, radiance.w);
    }
}
