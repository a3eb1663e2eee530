// Gives each cell of a grid in the world one flake.
#include "hit/surface_values.glsl"

// Three numbers in [0, 1) for a cell: Jarzynski and Olano, "Hash Functions for GPU Rendering" (JCGT 2020), pcg3d.
vec3 flakeRandom(ivec3 cell) {
    uvec3 v = uvec3(cell) * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v ^= v >> 16u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    return vec3(v >> 8u) * (1.0 / 16777216.0);
}

void flakesBsdf(Hit hit, Features features, inout SurfaceValues values, inout Surface surface) {
    vec3 random = flakeRandom(ivec3(floor(hit.position / GLINT_MATERIAL_FLAKE_SIZE(hit))));
    float sine = GLINT_MATERIAL_FLAKE_TILT(hit) * sqrt(random.x);
    float angle = 2.0 * kPi * random.y;
    vec3 normal = vec3(sine * cos(angle), sine * sin(angle), sqrt(max(1.0 - sine * sine, 1e-4)));
    // Not every cell has a flake. The rays of a pixel meet several cells, so the mean is the coverage.
    float coverage = random.z < GLINT_MATERIAL_FLAKE_COVERAGE(hit) ? 1.0 : 0.0;
    float roughness = GLINT_MATERIAL_FLAKE_ROUGHNESS(hit);
    surface.bsdf.layers.flakes.coverage = coverage;
    surface.bsdf.layers.flakes.color = GLINT_MATERIAL_FLAKE_COLOR(hit) * coverage;
    surface.bsdf.layers.flakes.facets = Clearcoat(1.0, max(roughness * roughness, kMinAlpha), normalize(normal));
}
