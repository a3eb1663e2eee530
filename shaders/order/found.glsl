// The first hit of a ray of the list: one that a host gives, or the one that the ray meets.
#include "hit/list.glsl"
#include "hit/trace.glsl"
#include "hit/path_ray.glsl"
#if GLINT_LAYER_RAYS
#include "layers/traced_hits.glsl"
#endif

#if GLINT_STEPS

HitRecord givenHit(uint index) {
    HitRecord hit = GLINT_FRAME.givenHits.data[index];
#ifdef GLINT_KEEPS_CORNERS
    if (hit.geometry != kMissGeometry) {
        HostGeometry geometry = hostGeometry(hit.geometry);
        hostPositions(geometry, hostTriangle(geometry, hit.primitive), tracedCorners);
    }
#endif
    return hit;
}

#endif

// Returns the hit of the ray `index`.
HitRecord hitOfRay(uint index, RayRecord ray) {
#if GLINT_STEPS
    if (GLINT_FRAME.givesHits != 0u && isHostsList()) {
        return givenHit(index);
    }
#endif
    TracedHit hit = traceRay(ray, rayFlags(ray.target));
#if GLINT_LAYER_RAYS
    keepTracedHit(ray, hit);
#endif
    return recordOf(hit);
}
