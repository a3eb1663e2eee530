// The reflection effect: which surfaces trace a ray, and which ray.
#include "hit/bindings.glsl"
#include "hit/geometry.glsl"

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

// The mirror direction about the shading normal. Where that points below the geometric surface it is lifted to leave
// it, by at least 1e-3 (a tenth of a degree), so that no ray starts into its own surface.
vec3 mirrorDirection(vec3 incoming, vec3 normal, vec3 geometricNormal) {
    vec3 direction = reflect(incoming, normal);
    float height = dot(direction, geometricNormal);
    return normalize(direction + geometricNormal * max(1e-3 - height, 0.0));
}
