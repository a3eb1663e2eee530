// The alpha of a candidate, for ray traversal over masked geometry.
#include "generated/mask_stages.glsl"
#include "hit/blend.glsl"

#if GLINT_BLENDED

// Returns a number that distinguishes rays, whichever strategy and tracer sends them.
uint rayKey(vec3 origin, vec3 direction) {
    uvec3 a = floatBitsToUint(origin);
    uvec3 b = floatBitsToUint(direction);
    return hashOf(hashOf(a.x, a.y, a.z), hashOf(b.x, b.y, b.z), 0u);
}
#endif

void countAlphaTest() {
#ifdef GLINT_FRAME
    if (kCountsLight) {
        atomicAdd(GLINT_FRAME.counters.data[kCounterAlphaTests], 1u);
    }
#endif
}

// Returns the alpha at a point of a triangle, and the cutoff. It reads mip 0, because traversal knows no footprint. The
// module's own cases do not matter here: a ray of any case meets masks of all cases.
vec2 alphaAndCutoff(HostGeometry geometry, uint primitive, vec2 barycentrics) {
    Features features = Features(GLINT_ALPHA_ALL, GLINT_KEY(geometry));
    SurfacePoint point = surfacePoint(geometry, primitive, barycentrics, features);
    MaterialRecord material = hostMaterials().data[point.material];
    runMaskCoordinates(point, features);
    float alpha = GLINT_BASE_ALPHA(material, features.model);
    if (inputOfKey(features, GLINT_ROLE_BASE_COLOR_TEXTURE)) {
        alpha *= samplePoint(point, GLINT_ROLE_BASE_COLOR_SLOT, features).a;
    }
    if (inputOfKey(features, GLINT_ROLE_VERTEX_COLOR)) {
        alpha *= vertexAlpha(geometry, primitive, barycentrics);
    }
    runMaskOpacity(point, features, alpha);
    return vec2(alpha, GLINT_ROLE_ALPHA_CUTOFF(material));
}

// Returns whether the ray stops at the candidate: the alpha test of glTF 2.0, section 3.9.4, or with alphaMode BLEND a
// random choice.
bool passesAlphaTest(vec3 origin, vec3 direction, uint geometryIndex, uint primitive, vec2 barycentrics) {
    HostGeometry geometry = hostGeometry(geometryIndex);
#if GLINT_SHADOW_GLASS
    if ((geometry.flags & kGeometryAlphaTested) == 0u) {
        return true;  // Glass without alpha is a candidate for the sake of shadow rays.
    }
#endif
    countAlphaTest();
    vec2 alpha = alphaAndCutoff(geometry, primitive, barycentrics);
#if GLINT_BLENDED
    if ((geometry.flags & kGeometryBlended) != 0u) {
        return alpha.x > blendThreshold(rayKey(origin, direction), geometryIndex, primitive);
    }
#endif
    return alpha.x >= alpha.y;
}

#if GLINT_EMISSIVE_LIGHTS
// The probability with which rays stop there.
float coverageAt(HostGeometry geometry, uint primitive, vec2 barycentrics) {
    vec2 alpha = alphaAndCutoff(geometry, primitive, barycentrics);
#if GLINT_BLENDED
    if ((geometry.flags & kGeometryBlended) != 0u) {
        return clamp(alpha.x, 0.0, 1.0);
    }
#endif
    return alpha.x >= alpha.y ? 1.0 : 0.0;
}
#endif
