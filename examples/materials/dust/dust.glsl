// Dust, in patches of a lattice of random numbers, on what faces upwards.
#include "hit/surface_values.glsl"

float dustRandom(ivec3 corner) {
    uvec3 v = uvec3(corner);
    uint h = v.x * 0x8da6b343u + v.y * 0xd8163841u + v.z * 0xcb1ab31fu;
    h = (h ^ h >> 15u) * 0x2c1b3c6du;
    h = (h ^ h >> 12u) * 0x297a2d39u;
    return float((h ^ h >> 15u) >> 8u) * (1.0 / 16777216.0);
}

// A smooth function with values in [0, 1].
float dustNoise(vec3 p) {
    ivec3 cell = ivec3(floor(p));
    vec3 f = p - floor(p);
    f = f * f * (3.0 - 2.0 * f);
    vec4 low = vec4(dustRandom(cell), dustRandom(cell + ivec3(1, 0, 0)), dustRandom(cell + ivec3(0, 1, 0)),
                    dustRandom(cell + ivec3(1, 1, 0)));
    vec4 high = vec4(dustRandom(cell + ivec3(0, 0, 1)), dustRandom(cell + ivec3(1, 0, 1)),
                     dustRandom(cell + ivec3(0, 1, 1)), dustRandom(cell + ivec3(1, 1, 1)));
    vec4 between = mix(low, high, f.z);
    vec2 rows = mix(between.xy, between.zw, f.y);
    return mix(rows.x, rows.y, f.x);
}

void dustSurface(Hit hit, Features features, inout SurfaceValues values) {
    float up = max(values.normal.y * facing(hit, features), 0.0);
    vec3 p = hit.position / GLINT_MATERIAL_DUST_SCALE(hit);
    float noise = 0.7 * dustNoise(p) + 0.3 * dustNoise(3.1 * p);
    float dust = smoothstep(0.0, 0.3, GLINT_MATERIAL_DUST_AMOUNT(hit) * (0.3 + 0.7 * up) - noise * (1.0 - up * up));
    values.color.rgb = mix(values.color.rgb, GLINT_MATERIAL_DUST_COLOR(hit), dust);
    values.metallic *= 1.0 - dust;
    values.roughness = mix(values.roughness, 1.0, dust);
}
