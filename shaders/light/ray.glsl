// Rays from a surface to a light, and the light that arrives.
#include "light/candidate.glsl"
#include "hit/trace.glsl"

#if GLINT_TRACER != 1 && !GLINT_RAY_GENERATION

// The module traces no ray.

#elif !GLINT_SHADOW_GLASS && !GLINT_SHADOW_OPAQUE

// Returns whether any light arrives; `light` then loses the part that surfaces on its way absorb: here nothing. Both
// sides of a surface cast shadows.
bool lightArrives(vec3 origin, vec3 direction, float distance, inout vec3 light) {
    return isVisible(origin, direction, distance);
}

#else

#if GLINT_EMISSIVE_LIGHTS && GLINT_SHADOW_GLASS
// True if the light of the last ray to a light has passed glass.
bool lightPassedGlass = false;
#define GLINT_NOTE_GLASS(passage) lightPassedGlass = passedGlass(passage);
#else
#define GLINT_NOTE_GLASS(passage)
#endif

#if GLINT_TRACER == 1

bool lightArrives(vec3 origin, vec3 direction, float distance, inout vec3 light) {
    GLINT_TALLY_RAYS(1u);
    rayQueryEXT query;
    rayQueryInitializeEXT(query, GLINT_TLAS, gl_RayFlagsTerminateOnFirstHitEXT | gl_RayFlagsSkipAABBEXT,
                          GLINT_RAY_MASK, origin, 0.0, direction, distance);
    LightPassage passage = wholePassage();
    while (rayQueryProceedEXT(query)) {
        GLINT_TALLY_CANDIDATES(1u);
        uint geometry = geometryOfHit(rayQueryGetIntersectionInstanceIdEXT(query, false),
                                      rayQueryGetIntersectionInstanceCustomIndexEXT(query, false),
                                      rayQueryGetIntersectionGeometryIndexEXT(query, false));
        PassageCandidate candidate = PassageCandidate(
            origin, direction, geometry, uint(rayQueryGetIntersectionPrimitiveIndexEXT(query, false)),
            rayQueryGetIntersectionBarycentricsEXT(query, false), rayQueryGetIntersectionTEXT(query, false));
        if (endsLight(candidate, passage)) {
            rayQueryConfirmIntersectionEXT(query);
        }
    }
    GLINT_NOTE_GLASS(passage)
    light *= lightAfter(passage, distance);
    return rayQueryGetIntersectionTypeEXT(query, true) == gl_RayQueryCommittedIntersectionNoneEXT;
}

#else

// The any-hit shader sees by the flags and by the payload that the ray goes to a light.
bool lightArrives(vec3 origin, vec3 direction, float distance, inout vec3 light) {
    GLINT_TALLY_RAYS(1u);
    const uint kFlags = gl_RayFlagsTerminateOnFirstHitEXT | gl_RayFlagsSkipClosestHitShaderEXT;
#ifdef GLINT_LIGHT_IN_HIT_PAYLOAD
    // The payload of rays in the list is free by now, and its miss shader sets a negative distance.
    shaded.radiance = vec3(1.0);
    shaded.direct = vec3(0.0);
    shaded.shadowOrigin = vec3(0.0);
    shaded.shadowDistance = 0.0;
    traceRayEXT(GLINT_TLAS, kFlags, GLINT_RAY_MASK, 0u, 0u, 0u, origin, 0.0, direction, distance, 0);
    GLINT_NOTE_GLASS(LightPassage(shaded.radiance, shaded.direct, shaded.shadowOrigin))
    light *= lightAfter(LightPassage(shaded.radiance, shaded.direct, shaded.shadowOrigin), distance);
    return shaded.shadowDistance < 0.0;
#else
    traced.geometry = kLightRay;
    traced.passage = wholePassage();
    traceRayEXT(GLINT_TLAS, kFlags, GLINT_RAY_MASK, 0u, 0u, GLINT_TRACE_LOCATION, origin, 0.0, direction, distance,
                GLINT_TRACE_LOCATION);
    GLINT_NOTE_GLASS(traced.passage)
    light *= lightAfter(traced.passage, distance);
    return traced.geometry == kMissGeometry;
#endif
}

#endif

#endif

#if GLINT_TRACER == 1 || GLINT_RAY_GENERATION
// Does the same for rays that see other surfaces: `sees` is one of kShadow*. If shadow rays do not pass glass, rays of
// lobes bring the light of emissive triangles through it. If shadow rays pass glass, rays of lobes leave that light
// out, so the sample counts whole.
bool lightArrivesTo(uint sees, vec3 origin, vec3 direction, float distance, inout vec3 light) {
#if GLINT_SHARED_LIGHTS
#if GLINT_SHADOW_GLASS || GLINT_SHADOW_OPAQUE
    if (sees == kShadowOfLight) {
        return lightArrives(origin, direction, distance, light);
    }
#endif
#if GLINT_EMISSIVE_LIGHTS && GLINT_SHADOW_GLASS
    if ((sees & kShadowKind) == kShadowPastGlass) {
        bool arrives = lightArrives(origin, direction, distance, light);
        light *= lightPassedGlass ? uintBitsToFloat(sees & ~kShadowKind) : 1.0;
        return arrives;
    }
#endif
    return isVisibleTo(sees, origin, direction, distance);
#else
    return lightArrives(origin, direction, distance, light);
#endif
}
#endif
