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
    uint hit = GLINT_FRAME.orderedHits.data[GLINT_FRAME.bucketBegins.data[0] + index];
    RayRecord ray = shadedRay(hit);
    if (storedGeometry(hit) == kMissGeometry) {
        resolveMiss(ray.target, ray.direction);
    } else {
#if !GLINT_FALLBACK
        atomicAdd(GLINT_FRAME.counters.data[kCounterUnknownShader], 1u);
        resolveUnknown(ray.target);
#endif
    }
}
