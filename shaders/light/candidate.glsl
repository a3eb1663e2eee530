// The part of a light's rays that remains where their straight way meets a surface (--shadow-through). The light
// neither bends nor spreads, for any index and roughness of the glass: caustics are left out.
#include "bsdf/features.glsl"
#include "hit/alpha.glsl"
#include "bsdf/constants.glsl"
#include "light/passage.glsl"
#include "materials/base/passage.glsl"
#include "host/geometry.glsl"
#include "host/material.glsl"

// The data of a traversal about a candidate.
struct PassageCandidate {
    vec3 origin;     // of the ray
    vec3 direction;  // of the ray, unit vector
    uint geometry;
    uint primitive;
    vec2 barycentrics;
    float distance;  // metres along the ray
};

#if GLINT_SHADOW_GLASS

#if GLINT_EMISSIVE_LIGHTS
bool passedGlass(LightPassage passage) {
    return passage.share.x + passage.share.y + passage.share.z < 0.0;
}
#define GLINT_SHARE_OF(passage) abs(passage.share)
#else
#define GLINT_SHARE_OF(passage) passage.share
#endif

// The light that arrives over a distance. A volume that is left but was never entered holds the surface, and one that
// is entered but never left holds the light. A light that is infinitely far away is in no volume: such a volume is no
// closed mesh, and absorbs nothing.
vec3 lightAfter(LightPassage passage, float distance) {
    vec3 behind = distance < kFarDistance ? max(passage.open, vec3(0.0)) * distance : vec3(0.0);
    return GLINT_SHARE_OF(passage) * exp(-max(passage.depth + behind, vec3(0.0)));
}

// The surface's colour with its coverage: base colour, texture and vertices.
vec4 pointColor(HostGeometry geometry, SurfacePoint point, PassageCandidate candidate, Features features) {
    vec4 color = GLINT_FILLS_BASE_COLOR(features.model) ? GLINT_ROLE_BASE_COLOR(GLINT_MATERIAL(point)) : vec4(1.0);
    if (inputOfKey(features, GLINT_ROLE_BASE_COLOR_TEXTURE)) {
        color *= samplePoint(point, GLINT_ROLE_BASE_COLOR_SLOT, features);
    }
    if (inputOfKey(features, GLINT_ROLE_VERTEX_COLOR)) {
        vec2 b = candidate.barycentrics;
        vec4 colors[3];
        hostColors(geometry, hostTriangle(geometry, candidate.primitive), colors);
        color *= (1.0 - b.x - b.y) * colors[0] + b.x * colors[1] + b.y * colors[2];
    }
    return color;
}

// The share that the surface covers: glTF 2.0, section 3.9.4. For BLEND it is the mean of the rays' random choices.
float coverageOf(HostGeometry geometry, SurfacePoint point, Features features, float alpha) {
#if GLINT_ALPHA_TESTED
    if ((geometry.flags & kGeometryAlphaTested) != 0u) {
        countAlphaTest();
        runMaskOpacity(point, features, alpha);
#if GLINT_BLENDED
        if ((geometry.flags & kGeometryBlended) != 0u) {
            return clamp(alpha, 0.0, 1.0);
        }
#endif
        return alpha >= GLINT_ROLE_ALPHA_CUTOFF(GLINT_MATERIAL(point)) ? 1.0 : 0.0;
    }
#endif
    return 1.0;
}

// Returns whether the light ends at the candidate. If it goes on, `passage` loses the part that the candidate absorbs.
bool endsLight(PassageCandidate candidate, inout LightPassage passage) {
    HostGeometry geometry = hostGeometry(candidate.geometry);
    Features features = Features(GLINT_ALPHA_ALL, GLINT_KEY(geometry));
    SurfacePoint point = surfacePoint(geometry, candidate.primitive, candidate.barycentrics, features);
    runMaskCoordinates(point, features);
    vec4 color = pointColor(geometry, point, candidate, features);
    float coverage = coverageOf(geometry, point, features, color.a);
    vec3 share = vec3(1.0 - coverage);
    bool passes = coverage > 0.0 && (geometry.flags & kGeometryPassesLight) != 0u &&
                  passesFacetsOfKey(features);
    if (passes) {
        vec3 corners[3];
        hostPositions(geometry, hostTriangle(geometry, candidate.primitive), corners);
        vec3 edge1 = corners[1] - corners[0];
        vec3 edge2 = corners[2] - corners[0];
        vec3 front = directionOr(transformNormal(hostInstance(geometry).normalToWorld, cross(edge1, edge2)),
                                 -candidate.direction);
        float cosine = dot(front, candidate.direction);
        share += coverage * sharePastInterface(point, features, color.rgb, abs(cosine));
        if (boundsAbsorberOfKey(features)) {
            vec3 absorption = absorptionAt(point);
            vec3 entered = cosine < 0.0 ? absorption : -absorption;
            passage.depth -= entered * candidate.distance;
            passage.open += entered;
        }
    }
#if GLINT_EMISSIVE_LIGHTS
    bool glass = passes || passedGlass(passage);
    vec3 left = abs(passage.share) * share;
    passage.share = glass ? -left : left;
    return !(left.x + left.y + left.z > 0.0);
#else
    passage.share *= share;
    return !(passage.share.x + passage.share.y + passage.share.z > 0.0);
#endif
}

#elif GLINT_SHADOW_OPAQUE

vec3 lightAfter(LightPassage passage, float distance) {
    return passage.share;
}

// BLEND covers all of the surface.
bool endsLight(PassageCandidate candidate, inout LightPassage passage) {
    return (hostGeometry(candidate.geometry).flags & kGeometryBlended) != 0u ||
           passesAlphaTest(candidate.origin, candidate.direction, candidate.geometry, candidate.primitive,
                           candidate.barycentrics);
}

#endif
