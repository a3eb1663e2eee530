// The parts that the shading passes of all strategies share: from a record to a Hit, and from a ShadeResult to the
// sample.
#include "hit/samples.glsl"
#include "hit/list.glsl"
#include "hit/record.glsl"
#include "generated/shade.glsl"
#include "light/shadow.glsl"
#if GLINT_LAYER_GROUPS
#include "layers/hit_group.glsl"
#endif

Hit loadHit(HitRecord record, RayRecord ray, HostGeometry geometry, Features features) {
    vec2 barycentrics = vec2(record.barycentricU, record.barycentricV);
#if GLINT_LAYER_GROUPS && !GLINT_RAY_GENERATION
    noteHitGroup(ray.target, geometry.shaderId);
#endif
    Hit hit = fetchHit(geometry, record.primitive, barycentrics, ray.direction, record.coneWidth, ray.target, features);
#if GLINT_PATHS
    hit.arrival = arrivalOf(samplePlace(ray.target), ray.origin, record.coneWidth, ray.coneSpread);
#endif
#if GLINT_EMISSIVE_LIGHTS
    hit.geometry = record.geometry;
    hit.primitive = record.primitive;
    hit.start = ray.origin;
#endif
    return hit;
}

#if !GLINT_ANSWERS_SURFACE
// Writes the light that the hit sends back to its sample. Its shadow ray is traced here, or put on the list of deferred
// rays.
void resolveHit(Hit hit, ShadeResult result) {
    vec3 radiance = result.radiance;
    if (result.shadowDistance > 0.0) {
#if GLINT_SHARED_LIGHTS
        uint sees = result.shadowSees;
#else
        uint sees = kShadowOfLight;
#endif
        ShadowRay shadow = ShadowRay(rayOrigin(hit, result.shadowDirection), result.shadowDirection,
                                     result.shadowDistance, result.direct, sees);
        radiance += lightOrDefer(hit.target, shadow);
    }
    storeRadiance(hit.target, radiance, kPathHit);
#if GLINT_PATHS
    storePath(hit, result.path);
#endif
}
#endif
