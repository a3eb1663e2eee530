// Noise for procedural materials: functions of a place alone, the same for primary surfaces and hits.

// A number in [0, 1) for a corner of a lattice.
float latticeRandom(ivec3 corner) {
    uvec3 v = uvec3(corner);
    uint h = v.x * 0x8da6b343u + v.y * 0xd8163841u + v.z * 0xcb1ab31fu;
    h = (h ^ h >> 15u) * 0x2c1b3c6du;
    h = (h ^ h >> 12u) * 0x297a2d39u;
    return float((h ^ h >> 15u) >> 8u) * (1.0 / 16777216.0);
}

// Value noise: a smooth function with values in [0, 1), which interpolates the numbers of a lattice's corners.
float valueNoise(vec3 p) {
    ivec3 cell = ivec3(floor(p));
    vec3 f = p - floor(p);
    f = f * f * (3.0 - 2.0 * f);
    vec4 low = vec4(latticeRandom(cell), latticeRandom(cell + ivec3(1, 0, 0)), latticeRandom(cell + ivec3(0, 1, 0)),
                    latticeRandom(cell + ivec3(1, 1, 0)));
    vec4 high = vec4(latticeRandom(cell + ivec3(0, 0, 1)), latticeRandom(cell + ivec3(1, 0, 1)),
                     latticeRandom(cell + ivec3(0, 1, 1)), latticeRandom(cell + ivec3(1, 1, 1)));
    vec4 between = mix(low, high, f.z);
    vec2 rows = mix(between.xy, between.zw, f.y);
    return mix(rows.x, rows.y, f.x);
}
