#version 460
// Shades bucket 0: rays that left the scene see the sky, and need no shadow ray.
#include "host/sky.glsl"
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
    vec3 radiance = vec3(1.0, 0.0, 1.0);
    uint path = kPathHit;
    if (hit.geometry == kMissGeometry) {
        radiance = hostSky(missDirection(hit));
        path = kPathMiss;
    } else {
        atomicAdd(GLINT_FRAME.counters.data[kCounterUnknownShader], 1u);
    }
    storeRadiance(hit.target, radiance, path);
}
