// The any-hit shader of rays: the alpha test of a candidate, or the random choice of one that is blended. A ray to a
// light may keep a share of its light. GLINT_ANY_HIT_OF_HITS: the pipeline is that of the strategy hit-shaders, and the
// payload with it.
#extension GL_EXT_ray_tracing : require
#include "hit/alpha.glsl"
#include "hit/geometry_index.glsl"
#include "light/candidate.glsl"
#include "hit/payload.glsl"

hitAttributeEXT vec2 hitBarycentrics;

#if GLINT_SHADOW_GLASS || GLINT_SHADOW_OPAQUE

#ifdef GLINT_ANY_HIT_OF_HITS
layout(location = 0) rayPayloadInEXT HitPayload shaded;
#else
layout(location = 0) rayPayloadInEXT TracePayload traced;
#endif

// Rays of the list run closest-hit shaders, and those of ambient occlusion have another payload.
bool goesToLight() {
    bool finds = (gl_IncomingRayFlagsEXT & gl_RayFlagsSkipClosestHitShaderEXT) != 0u;
#ifdef GLINT_ANY_HIT_OF_HITS
    // Rays to emissive triangles don't end at the first hit here, and have the other payload.
    return finds && (gl_IncomingRayFlagsEXT & gl_RayFlagsTerminateOnFirstHitEXT) != 0u;
#else
    return finds && traced.geometry == kLightRay;
#endif
}

bool lightEndsHere(uint geometry) {
    PassageCandidate candidate = PassageCandidate(gl_WorldRayOriginEXT, gl_WorldRayDirectionEXT, geometry,
                                                  uint(gl_PrimitiveID), hitBarycentrics, gl_HitTEXT);
#ifdef GLINT_ANY_HIT_OF_HITS
    LightPassage passage = LightPassage(shaded.radiance, shaded.direct, shaded.shadowOrigin);
    bool ends = endsLight(candidate, passage);
    shaded.radiance = passage.share;
    shaded.direct = passage.depth;
    shaded.shadowOrigin = passage.open;
    return ends;
#else
    return endsLight(candidate, traced.passage);
#endif
}

#endif

void main() {
    uint candidate = geometryOfHit(gl_InstanceID, gl_InstanceCustomIndexEXT, gl_GeometryIndexEXT);
#if GLINT_SHADOW_GLASS || GLINT_SHADOW_OPAQUE
    bool stops = goesToLight() ? lightEndsHere(candidate)
                               : passesAlphaTest(gl_WorldRayOriginEXT, gl_WorldRayDirectionEXT, candidate,
                                                 uint(gl_PrimitiveID), hitBarycentrics);
#else
    bool stops = passesAlphaTest(gl_WorldRayOriginEXT, gl_WorldRayDirectionEXT, candidate, uint(gl_PrimitiveID),
                                 hitBarycentrics);
#endif
    if (!stops) {
        ignoreIntersectionEXT;
    }
}
