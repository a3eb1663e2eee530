// The reflection effect: which surfaces trace a ray, and which ray.
#include "hit/bindings.glsl"
#include "hit/geometry.glsl"
#include "hit/surface.glsl"

// Roughness of a pixel that reflects nothing: no surface, or an unlit one.
const float kNoReflection = -1.0;
const float kUnlitSurface = -2.0;

// How much of a surface's reflection its ray brings; the sky stands in for the rest. Falls to 0 over the last fifth
// below the roughness limit, so that no edge shows where a texture crosses it; at the limit a ray is still worth sending.
float tracedShare(float roughness) {
    float limit = GLINT_FRAME.maxReflectionRoughness;
    if (roughness > limit) {
        return 0.0;
    }
    float fade = limit > 0.0 ? clamp((roughness - 0.8 * limit) / (0.2 * limit), 0.0, 0.999) : 0.0;
    return 1.0 - fade * fade * (3.0 - 2.0 * fade);
}

// What a pixel's one ray brings: the reflection of the base, of the coat, or of both where their normals agree.
struct TracedLobe {
    vec3 normal;
    float roughness;
    vec3 weight;
    float base;  // share of the base's reflection that the ray brings
    float coat;
};

TracedLobe tracedLobe(Surface surface, Features features) {
    float base = tracedShare(surface.roughness);
    TracedLobe lobe = TracedLobe(surface.normal, surface.roughness, vec3(0.0), base, 0.0);
    if (hasLobe(features, GLINT_CLEARCOAT)) {
        float coatRoughness = sqrt(surface.bsdf.clearcoatAlpha);
        float coat = tracedShare(coatRoughness);
        float coatWeight = coat * coatReflectance(surface, features);
        bool together = surface.bsdf.clearcoatNormal.z > 0.99999;  // a quarter of a degree
        bool coatOnly = !together && coatWeight > base * luminance(baseReflectance(surface, features));
        lobe.coat = together || coatOnly ? coat : 0.0;
        if (coatOnly) {
            lobe.base = 0.0;
            lobe.normal = toWorld(surface, surface.bsdf.clearcoatNormal);
            lobe.roughness = coatRoughness;
        } else if (together) {
            lobe.roughness = min(surface.roughness, coatRoughness);
        }
        lobe.weight = vec3(lobe.coat * coatReflectance(surface, features));
    }
    lobe.weight += lobe.base * baseReflectance(surface, features);
    return lobe;
}

// The mirror direction about the shading normal. Where that points below the geometric surface it is lifted to leave
// it, by at least 1e-3 (a tenth of a degree), so that no ray starts into its own surface.
vec3 mirrorDirection(vec3 incoming, vec3 normal, vec3 geometricNormal) {
    vec3 direction = reflect(incoming, normal);
    float height = dot(direction, geometricNormal);
    return normalize(direction + geometricNormal * max(1e-3 - height, 0.0));
}
