#version 460
// Shades bucket 0: rays that left the scene see the sky, and need no shadow ray.
#include "generated/answer.glsl"
#include "hit/list.glsl"
#include "hit/record.glsl"
#include "hit/samples.glsl"

GLINT_RAY_WORKGROUP

void main() {
    uint index = listIndex();
    if (index >= GLINT_FRAME.bucketCounts.data[0]) {
        return;
    }
    HitRecord hit = storedHit(GLINT_FRAME.orderedHits.data[GLINT_FRAME.bucketBegins.data[0] + index]);
    if (hit.geometry == kMissGeometry) {
        resolveMiss(hit.target, missDirection(hit));
    } else {
#if !GLINT_FALLBACK
        atomicAdd(GLINT_FRAME.counters.data[kCounterUnknownShader], 1u);
        resolveUnknown(hit.target);
#endif
    }
}
