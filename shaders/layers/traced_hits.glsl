// Stores the hit of a ray of the list, for layers.
#include "hit/trace.glsl"
#include "layers/ray_hits.glsl"

void keepTracedHit(RayRecord ray, TracedHit hit) {
    if (hit.geometry == kMissGeometry) {
        storeRayMiss(ray.target, ray.direction);
    } else {
        storeRayHit(ray.target, hit.geometry, hit.primitive, hit.barycentrics, ray.direction, hit.distance);
    }
}
