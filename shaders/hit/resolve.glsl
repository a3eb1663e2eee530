// What the shading passes of all strategies share: from a record to a Hit, and from a ShadeResult to radiance.
#include "hit/images.glsl"
#include "hit/list.glsl"
#include "hit/shade.glsl"
#include "hit/trace.glsl"

Hit loadHit(HitRecord record, GeometryRecord geometry, Features features) {
    RayRecord ray = GLINT_FRAME.rays.data[record.ray];
    vec2 barycentrics = vec2(record.barycentricU_orDirectionX, record.barycentricV_orDirectionY);
    return fetchHit(geometry, record.primitive, barycentrics, ray.direction, record.coneWidth, record.pixel,
                    features);
}

// Traces the shadow ray, if there is one.
vec3 resolveRadiance(Hit hit, ShadeResult result) {
    vec3 radiance = result.radiance;
    if (result.shadowDistance > 0.0) {
        if (isVisible(rayOrigin(hit, result.shadowDirection), result.shadowDirection, result.shadowDistance)) {
            radiance += result.direct;
        }
    }
    return radiance;
}
