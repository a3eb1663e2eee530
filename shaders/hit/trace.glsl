// Traces rays by ray queries, or by a ray tracing pipeline.
#include "hit/alpha.glsl"
#include "bsdf/constants.glsl"
#include "hit/geometry_index.glsl"
#include "hit/payload.glsl"
#include "hit/stage.glsl"
#include "hit/tlas.glsl"
#include "packed/hit_codes.glsl"
#if GLINT_TALLIES
#include "generated/tallies.glsl"
#endif

// The first surface that a ray meets.
struct TracedHit {
    uint geometry;  // kMissGeometry if it leaves the scene
    uint primitive;
    vec2 barycentrics;
    float distance;   // metres
    float coneWidth;  // width of the ray cone there, metres
};

TracedHit tracedMiss() {
    return TracedHit(kMissGeometry, 0u, vec2(0.0), 0.0, 0.0);
}

TracedHit tracedHit(RayRecord ray, TracePayload found) {
#if GLINT_HITS_IN_SAMPLES
    // The width is rounded where it is kept, so that all strategies need the same last bit.
    precise float coneWidth = ray.coneWidth + ray.coneSpread * found.distance;
    return TracedHit(found.geometry, found.primitive, found.barycentrics, found.distance, coneWidth);
#else
    return TracedHit(found.geometry, found.primitive, found.barycentrics, found.distance,
                     ray.coneWidth + ray.coneSpread * found.distance);
#endif
}

HitRecord recordOf(TracedHit hit) {
#if GLINT_HITS_IN_SAMPLES
    vec2 barycentrics = keptBarycentrics(hit.barycentrics);
    return HitRecord(hit.geometry, hit.primitive, barycentrics.x, barycentrics.y, keptConeWidth(hit.coneWidth));
#else
    return HitRecord(hit.geometry, hit.primitive, hit.barycentrics.x, hit.barycentrics.y, hit.coneWidth);
#endif
}

#if GLINT_TRACER == 1

// Queries have the shape that mobile compilers make fast: one proceed for each initialise, called unconditionally,
// opaque, no AABBs. Only a package that tests alpha loops over candidates.
#extension GL_EXT_ray_query : require
#extension GL_EXT_ray_flags_primitive_culling : require

#if GLINT_ALPHA_TESTED
const uint kOpacityFlags = gl_RayFlagsSkipAABBEXT;
#define GLINT_PROCEED(query, origin, direction)                                                                 \
    while (rayQueryProceedEXT(query)) {                                                                         \
        GLINT_TALLY_CANDIDATES(1u);                                                                             \
        uint candidate = geometryOfHit(rayQueryGetIntersectionInstanceIdEXT(query, false),                      \
                                       rayQueryGetIntersectionInstanceCustomIndexEXT(query, false),             \
                                       rayQueryGetIntersectionGeometryIndexEXT(query, false));                  \
        if (passesAlphaTest(origin, direction, candidate,                                                       \
                            uint(rayQueryGetIntersectionPrimitiveIndexEXT(query, false)),                       \
                            rayQueryGetIntersectionBarycentricsEXT(query, false))) {                            \
            rayQueryConfirmIntersectionEXT(query);                                                              \
        }                                                                                                       \
    }
#else
const uint kOpacityFlags = gl_RayFlagsOpaqueEXT | gl_RayFlagsSkipAABBEXT;
#define GLINT_PROCEED(query, origin, direction) rayQueryProceedEXT(query)
#endif

// Returns the closest hit of a ray.
TracedHit traceRay(RayRecord ray, uint flags) {
    GLINT_TALLY_RAYS(1u);
    rayQueryEXT query;
    rayQueryInitializeEXT(query, GLINT_TLAS, kOpacityFlags | flags, GLINT_RAY_MASK, ray.origin, 0.0,
                          ray.direction, kFarDistance);
    GLINT_PROCEED(query, ray.origin, ray.direction);
    if (rayQueryGetIntersectionTypeEXT(query, true) == gl_RayQueryCommittedIntersectionNoneEXT) {
        return tracedMiss();
    }
#ifdef GLINT_KEEPS_CORNERS
    rayQueryGetIntersectionTriangleVertexPositionsEXT(query, true, tracedCorners);
#endif
    TracePayload found;
    found.geometry = geometryOfHit(rayQueryGetIntersectionInstanceIdEXT(query, true),
                                   rayQueryGetIntersectionInstanceCustomIndexEXT(query, true),
                                   rayQueryGetIntersectionGeometryIndexEXT(query, true));
    found.primitive = uint(rayQueryGetIntersectionPrimitiveIndexEXT(query, true));
    found.barycentrics = rayQueryGetIntersectionBarycentricsEXT(query, true);
    found.distance = rayQueryGetIntersectionTEXT(query, true);
    return tracedHit(ray, found);
}

// Returns whether nothing stands in the way, seen from either side. lightArrives() (light/ray.glsl) instead returns the
// share of a light that arrives.
bool isVisible(vec3 origin, vec3 direction, float distance) {
    GLINT_TALLY_RAYS(1u);
    rayQueryEXT query;
    rayQueryInitializeEXT(query, GLINT_TLAS, kOpacityFlags | gl_RayFlagsTerminateOnFirstHitEXT,
                          GLINT_RAY_MASK, origin, 0.0, direction, distance);
    GLINT_PROCEED(query, origin, direction);
    return rayQueryGetIntersectionTypeEXT(query, true) == gl_RayQueryCommittedIntersectionNoneEXT;
}

#if GLINT_SHARED_LIGHTS
// Does the same for rays that see other surfaces (kShadow*).
bool isVisibleTo(uint sees, vec3 origin, vec3 direction, float distance) {
    GLINT_TALLY_RAYS(1u);
    uint culled = sees == kShadowOfShared ? gl_RayFlagsCullBackFacingTrianglesEXT : 0u;
    rayQueryEXT query;
    rayQueryInitializeEXT(query, GLINT_TLAS, kOpacityFlags | gl_RayFlagsTerminateOnFirstHitEXT | culled,
                          GLINT_RAY_MASK, origin, 0.0, direction, distance);
    GLINT_PROCEED(query, origin, direction);
    return rayQueryGetIntersectionTypeEXT(query, true) == gl_RayQueryCommittedIntersectionNoneEXT;
}
#endif

// Returns the distance to the closest surface within `most`, seen from either side, or `most` if there is none.
float closestDistance(vec3 origin, vec3 direction, float most) {
    GLINT_TALLY_RAYS(1u);
    rayQueryEXT query;
    rayQueryInitializeEXT(query, GLINT_TLAS, kOpacityFlags, GLINT_RAY_MASK, origin, 0.0, direction, most);
    GLINT_PROCEED(query, origin, direction);
    return rayQueryGetIntersectionTypeEXT(query, true) == gl_RayQueryCommittedIntersectionNoneEXT
               ? most
               : rayQueryGetIntersectionTEXT(query, true);
}

#elif GLINT_RAY_GENERATION

#ifndef GLINT_TRACE_LOCATION
#define GLINT_TRACE_LOCATION 0  // location of the payload, and the number of its miss shader
#endif

layout(location = GLINT_TRACE_LOCATION) rayPayloadEXT TracePayload traced;

#if GLINT_ALPHA_TESTED
const uint kOpacityFlags = gl_RayFlagsNoneEXT;
#else
const uint kOpacityFlags = gl_RayFlagsOpaqueEXT;
#endif

// Does the same as the function for ray queries above.
TracedHit traceRay(RayRecord ray, uint flags) {
    GLINT_TALLY_RAYS(1u);
    traceRayEXT(GLINT_TLAS, kOpacityFlags | flags, GLINT_RAY_MASK, 0u, 0u, GLINT_TRACE_LOCATION, ray.origin,
                0.0, ray.direction, kFarDistance, GLINT_TRACE_LOCATION);
    return traced.geometry == kMissGeometry ? tracedMiss() : tracedHit(ray, traced);
}

bool isVisible(vec3 origin, vec3 direction, float distance) {
    GLINT_TALLY_RAYS(1u);
    // A ray that hits leaves this value unchanged.
    traced.geometry = 0u;
    traceRayEXT(GLINT_TLAS,
                kOpacityFlags | gl_RayFlagsTerminateOnFirstHitEXT | gl_RayFlagsSkipClosestHitShaderEXT, GLINT_RAY_MASK, 0u, 0u,
                GLINT_TRACE_LOCATION, origin, 0.0, direction, distance, GLINT_TRACE_LOCATION);
    return traced.geometry == kMissGeometry;
}

#if GLINT_SHARED_LIGHTS
bool isVisibleTo(uint sees, vec3 origin, vec3 direction, float distance) {
    GLINT_TALLY_RAYS(1u);
    uint culled = sees == kShadowOfShared ? gl_RayFlagsCullBackFacingTrianglesEXT : 0u;
    traced.geometry = 0u;
#if defined(GLINT_LIGHT_IN_HIT_PAYLOAD) && (GLINT_SHADOW_GLASS || GLINT_SHADOW_OPAQUE)
    const uint kEnd = gl_RayFlagsNoneEXT;  // The any-hit shader knows rays to other lights by the flag (hit/any_hit.glsl).
#else
    const uint kEnd = gl_RayFlagsTerminateOnFirstHitEXT;
#endif
    traceRayEXT(GLINT_TLAS, kOpacityFlags | kEnd | gl_RayFlagsSkipClosestHitShaderEXT | culled,
                GLINT_RAY_MASK, 0u, 0u, GLINT_TRACE_LOCATION, origin, 0.0, direction, distance, GLINT_TRACE_LOCATION);
    return traced.geometry == kMissGeometry;
}
#endif

// Does the same as the function for ray queries above.
float closestDistance(vec3 origin, vec3 direction, float most) {
    GLINT_TALLY_RAYS(1u);
    traceRayEXT(GLINT_TLAS, kOpacityFlags, GLINT_RAY_MASK, 0u, 0u, GLINT_TRACE_LOCATION, origin, 0.0,
                direction, most, GLINT_TRACE_LOCATION);
    return traced.geometry == kMissGeometry ? most : traced.distance;
}

#endif

#if GLINT_SHARED_LIGHTS == 0
#define isVisibleTo(sees, origin, direction, distance) isVisible(origin, direction, distance)
#endif
