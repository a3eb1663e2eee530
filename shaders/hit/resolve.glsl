// What the shading passes of all strategies share: from a record to a Hit, and from a ShadeResult to the pixel.
#include "hit/images.glsl"
#include "hit/list.glsl"
#include "hit/record.glsl"
#include "hit/shade.glsl"
#include "hit/shadow.glsl"

Hit loadHit(HitRecord record, vec3 direction, GeometryRecord geometry, Features features) {
    vec2 barycentrics = vec2(record.barycentricU_orDirectionX, record.barycentricV_orDirectionY);
    return fetchHit(geometry, record.primitive, barycentrics, direction, record.coneWidth, record.pixel, features);
}

// Direction of the ray of a stored hit.
vec3 rayDirection(HitRecord record, GeometryRecord geometry) {
#if GLINT_HIT_RECORD_PACKED
    // From where the pixel's ray began to the point of the triangle.
    vec2 barycentrics = vec2(record.barycentricU_orDirectionX, record.barycentricV_orDirectionY);
    vec3 point = trianglePosition(geometry, record.primitive, barycentrics);
    return normalize(point - imageLoad(positionImage, pixelCoordinates(record.pixel)).xyz);
#else
    return GLINT_FRAME.rays.data[record.ray].direction;
#endif
}

void resolveMiss(uint pixel, vec3 direction) {
    imageStore(reflectionImage, pixelCoordinates(pixel), vec4(skyRadiance(direction), float(kPathMiss)));
}

// Writes what the hit sends back to its pixel. Its shadow ray is traced here, or put on the list of those that wait.
void resolveHit(Hit hit, ShadeResult result) {
    vec3 radiance = result.radiance;
    if (result.shadowDistance > 0.0) {
        ShadowRay shadow = ShadowRay(rayOrigin(hit, result.shadowDirection), result.shadowDirection,
                                     result.shadowDistance, result.direct);
        radiance += lightOrDefer(hit.pixel, shadow);
    }
    imageStore(reflectionImage, pixelCoordinates(hit.pixel), vec4(radiance, float(kPathHit)));
}
