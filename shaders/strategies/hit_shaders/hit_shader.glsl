// The closest-hit shaders of the strategy hit-shaders. They shade; ray generation traces the shadow ray.
#extension GL_EXT_ray_tracing : require

#include "generated/scene.glsl"
#if GLINT_POSITION_FETCH
#extension GL_EXT_ray_tracing_position_fetch : require
#define GLINT_CORNER(i) gl_HitTriangleVertexPositionsEXT[i]
#endif
#include "strategies/hit_shaders/payload.glsl"
#include "hit/geometry_index.glsl"
#include "generated/shade.glsl"
#include "packed/hit_codes.glsl"
#if GLINT_LAYER_RAYS
#include "layers/ray_hits.glsl"
#endif

layout(location = 0) rayPayloadInEXT HitPayload shaded;
hitAttributeEXT vec2 hitBarycentrics;

uint hitGeometry() {
    return geometryOfHit(gl_InstanceID, gl_InstanceCustomIndexEXT, gl_GeometryIndexEXT);
}

Hit shadedHit(HostGeometry geometry, Features features) {
    uint target = floatBitsToUint(shaded.radiance.x);
#if GLINT_HITS_IN_SAMPLES
    precise float exactWidth = shaded.radiance.y + shaded.radiance.z * gl_HitTEXT;
    float coneWidth = keptConeWidth(exactWidth);
    Hit hit = fetchHit(geometry, uint(gl_PrimitiveID), keptBarycentrics(hitBarycentrics), gl_WorldRayDirectionEXT,
                       coneWidth, target, features);
#else
    float coneWidth = shaded.radiance.y + shaded.radiance.z * gl_HitTEXT;
    Hit hit = fetchHit(geometry, uint(gl_PrimitiveID), hitBarycentrics, gl_WorldRayDirectionEXT, coneWidth, target,
                       features);
#endif
#if GLINT_LAYER_RAYS
    storeRayHit(target, hitGeometry(), uint(gl_PrimitiveID), hitBarycentrics, gl_WorldRayDirectionEXT, gl_HitTEXT);
#endif
#if GLINT_PATHS
    hit.arrival = arrivalOf(samplePlace(target), gl_WorldRayOriginEXT, coneWidth, shaded.radiance.z);
#endif
#if GLINT_EMISSIVE_LIGHTS
    hit.geometry = hitGeometry();
    hit.primitive = uint(gl_PrimitiveID);
    hit.start = gl_WorldRayOriginEXT;
#endif
    return hit;
}

#if GLINT_ANSWERS_SURFACE
// The payload says only that there was a hit: the answer is too large for it.
void returnShaded(Hit hit, ShadeResult result) {
    storeSurface(hit.target, result.surface);
    shaded.shadowDistance = 0.0;
}
#else
void returnShaded(Hit hit, ShadeResult result) {
    shaded.radiance = result.radiance;
    shaded.direct = result.direct;
    shaded.shadowOrigin = rayOrigin(hit, result.shadowDirection);
    shaded.shadowDirection = result.shadowDirection;
    shaded.shadowDistance = result.shadowDistance;
#if GLINT_SHARED_LIGHTS
    shaded.shadowSees = result.shadowSees;
#endif
#if GLINT_PATHS
    // The next ray waits in memory, where the other strategies leave it too, and the payload stays small.
    storePath(hit, result.path);
#endif
}
#endif
