// Ray queries, in the shape that mobile compilers make fast: one proceed for each initialise, called unconditionally,
// opaque, no AABBs. Only a package that tests alpha loops over candidates.
#extension GL_EXT_ray_query : require
#extension GL_EXT_ray_flags_primitive_culling : require

#include "hit/alpha.glsl"
#include "hit/constants.glsl"

layout(set = kSetScene, binding = kBindingTlas) uniform accelerationStructureEXT sceneTlas[];

#if GLINT_ALPHA_TESTED
const uint kOpacityFlags = gl_RayFlagsSkipAABBEXT;
#define GLINT_PROCEED(query)                                                                                    \
    while (rayQueryProceedEXT(query)) {                                                                         \
        uint candidate = uint(rayQueryGetIntersectionInstanceCustomIndexEXT(query, false) +                     \
                              rayQueryGetIntersectionGeometryIndexEXT(query, false));                           \
        if (passesAlphaTest(GLINT_FRAME.geometries.data[candidate],                                             \
                            uint(rayQueryGetIntersectionPrimitiveIndexEXT(query, false)),                       \
                            rayQueryGetIntersectionBarycentricsEXT(query, false))) {                            \
            rayQueryConfirmIntersectionEXT(query);                                                              \
        }                                                                                                       \
    }
#else
const uint kOpacityFlags = gl_RayFlagsOpaqueEXT | gl_RayFlagsSkipAABBEXT;
#define GLINT_PROCEED(query) rayQueryProceedEXT(query)
#endif

// The closest hit of a ray of the list. Back faces of single-sided geometry let it pass, as they do in the raster
// pass.
HitRecord traceRay(RayRecord ray, uint rayIndex) {
    rayQueryEXT query;
    rayQueryInitializeEXT(query, sceneTlas[pushed.tlasIndex],
                          kOpacityFlags | gl_RayFlagsCullBackFacingTrianglesEXT, 0xFFu, ray.origin, 0.0,
                          ray.direction, kFarDistance);
    GLINT_PROCEED(query);
    HitRecord hit;
    hit.pixel = ray.pixel;
    hit.ray = rayIndex;
    if (rayQueryGetIntersectionTypeEXT(query, true) == gl_RayQueryCommittedIntersectionNoneEXT) {
        hit.geometry = kMissGeometry;
        hit.primitive = 0u;
        hit.barycentricU_orDirectionX = ray.direction.x;
        hit.barycentricV_orDirectionY = ray.direction.y;
        hit.distance_orDirectionZ = ray.direction.z;
        hit.coneWidth = 0.0;
        return hit;
    }
    vec2 barycentrics = rayQueryGetIntersectionBarycentricsEXT(query, true);
    hit.geometry = uint(rayQueryGetIntersectionInstanceCustomIndexEXT(query, true) +
                        rayQueryGetIntersectionGeometryIndexEXT(query, true));
    hit.primitive = uint(rayQueryGetIntersectionPrimitiveIndexEXT(query, true));
    hit.barycentricU_orDirectionX = barycentrics.x;
    hit.barycentricV_orDirectionY = barycentrics.y;
    hit.distance_orDirectionZ = rayQueryGetIntersectionTEXT(query, true);
    hit.coneWidth = ray.coneWidth + ray.coneSpread * hit.distance_orDirectionZ;
    return hit;
}

// Whether nothing stands between `origin` and a light. Both sides of a surface cast shadows.
bool isVisible(vec3 origin, vec3 direction, float distance) {
    rayQueryEXT query;
    rayQueryInitializeEXT(query, sceneTlas[pushed.tlasIndex], kOpacityFlags | gl_RayFlagsTerminateOnFirstHitEXT,
                          0xFFu, origin, 0.0, direction, distance);
    GLINT_PROCEED(query);
    return rayQueryGetIntersectionTypeEXT(query, true) == gl_RayQueryCommittedIntersectionNoneEXT;
}
