// Lava: light from where two fields of noise that drift apart are alike, which is a net of cracks.
#include "hit/noise.glsl"
#include "hit/surface_values.glsl"

void lavaEmission(Hit hit, Features features, inout vec3 emitted) {
    vec3 p = hit.position / GLINT_MATERIAL_LAVA_SCALE(hit);
    float t = frameTime() * GLINT_MATERIAL_LAVA_SPEED(hit);
    float field = valueNoise(p + vec3(0.0, t, 0.0)) + 0.5 * valueNoise(2.0 * p + vec3(t, 0.0, 0.0)) -
                  valueNoise(1.3 * p + vec3(0.0, 0.6 * t, 11.0)) - 0.5 * valueNoise(2.3 * p + vec3(5.0, 0.0, -t));
    float glow = max(1.0 - 6.0 * abs(field), 0.0);
    // The hottest parts are nearly white.
    vec3 color = mix(GLINT_MATERIAL_LAVA_COLOR(hit), vec3(1.0, 0.8, 0.4), glow * glow);
    emitted += GLINT_MATERIAL_LAVA_STRENGTH(hit) * glow * glow * color;
}
