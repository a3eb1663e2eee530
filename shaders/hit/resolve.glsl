// What the shading passes of all strategies share: from a record to a Hit, and from a ShadeResult to the sample.
#include "hit/samples.glsl"
#include "hit/list.glsl"
#include "hit/record.glsl"
#include "hit/shade.glsl"
#include "hit/shadow.glsl"

Hit loadHit(HitRecord record, vec3 direction, GeometryRecord geometry, Features features) {
    vec2 barycentrics = vec2(record.barycentricU_orDirectionX, record.barycentricV_orDirectionY);
    return fetchHit(geometry, record.primitive, barycentrics, direction, record.coneWidth, record.target, features);
}

// Direction of the ray of a stored hit.
vec3 rayDirection(HitRecord record, GeometryRecord geometry) {
#if GLINT_HIT_RECORD_PACKED
    // From where the ray began to the point of the triangle.
    vec2 barycentrics = vec2(record.barycentricU_orDirectionX, record.barycentricV_orDirectionY);
    vec3 point = trianglePosition(geometry, record.primitive, barycentrics);
    return normalize(point - GLINT_FRAME.samples.data[record.target].origin);
#else
    return GLINT_FRAME.rays.data[record.ray].direction;
#endif
}

void resolveMiss(uint target, vec3 direction) {
    storeRadiance(target, skyRadiance(direction), kPathMiss);
}

// Writes what the hit sends back to its sample. Its shadow ray is traced here, or put on the list of those that wait.
void resolveHit(Hit hit, ShadeResult result) {
    vec3 radiance = result.radiance;
    if (result.shadowDistance > 0.0) {
        ShadowRay shadow = ShadowRay(rayOrigin(hit, result.shadowDirection), result.shadowDirection,
                                     result.shadowDistance, result.direct);
        radiance += lightOrDefer(hit.target, shadow);
    }
    storeRadiance(hit.target, radiance, kPathHit);
}
