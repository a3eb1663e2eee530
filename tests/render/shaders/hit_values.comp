#version 460
// Fetches the geometry of given hits. In each RayRecord, origin.xy are the barycentrics, origin.z is the
// anisotropy of the sampler, pixel is the geometry, coneSpread is the triangle, and coneWidth is the width of
// the cone at the hit.
#include "hit/hit.glsl"
#include "hit/trace.glsl"

layout(local_size_x = kRayGroupSize) in;

const uint kWords = 26u;
const vec2 kTexels = vec2(1024.0, 512.0);

void writeVector(uint place, vec3 v) {
    for (uint i = 0u; i < 3u; ++i) {
        GLINT_FRAME.counters.data[place + i] = floatBitsToUint(v[i]);
    }
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= GLINT_FRAME.width) {
        return;
    }
    RayRecord ray = GLINT_FRAME.rays.data[index];
    GeometryRecord geometry = GLINT_FRAME.geometries.data[ray.target];
    Hit hit = fetchHit(geometry, uint(ray.coneSpread), ray.origin.xy, ray.direction, ray.coneWidth, index,
                       GLINT_PRIMARY_FEATURES(geometry));
    uint base = index * kWords;
    writeVector(base, hit.position);
    writeVector(base + 3u, hit.geometricNormal);
    writeVector(base + 6u, hit.normal);
    writeVector(base + 9u, vec3(hit.texCoords[0], hit.frontFace ? 1.0 : 0.0));
    writeVector(base + 12u, hit.color.rgb);
    writeVector(base + 15u, hit.tangent.xyz);
    vec4 gradients = coneGradients(hit.footprint, hit.uvEdges[0], kTexels, ray.origin.z);
    writeVector(base + 18u, vec3(hit.tangent.w, hit.clearance, gradients.x));
    writeVector(base + 21u, gradients.yzw);
    // Stores whether a metre above the surface, and below it, is free.
    vec3 n = hit.geometricNormal;
    GLINT_FRAME.counters.data[base + 24u] = isVisible(rayOrigin(hit, n), n, 1.0) ? 1u : 0u;
    GLINT_FRAME.counters.data[base + 25u] = isVisible(rayOrigin(hit, -n), -n, 1.0) ? 1u : 0u;
}
