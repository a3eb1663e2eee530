// Dust, in patches of a lattice of random numbers, on what faces upwards.
#include "hit/noise.glsl"
#include "hit/surface_values.glsl"

void dustSurface(Hit hit, Features features, inout SurfaceValues values) {
    float up = max(values.normal.y * facing(hit, features), 0.0);
    vec3 p = hit.position / GLINT_MATERIAL_DUST_SCALE(hit);
    float noise = 0.7 * valueNoise(p) + 0.3 * valueNoise(3.1 * p);
    float dust = smoothstep(0.0, 0.3, GLINT_MATERIAL_DUST_AMOUNT(hit) * (0.3 + 0.7 * up) - noise * (1.0 - up * up));
    values.color.rgb = mix(values.color.rgb, GLINT_MATERIAL_DUST_COLOR(hit), dust);
    values.metallic *= 1.0 - dust;
    values.roughness = mix(values.roughness, 1.0, dust);
}
