#version 460
// Leaves the surface that a ray hits, on both sides, and counts which rays hit the same triangle again: from
// the hit itself, from an offset in units in the last place, and from where the product's rays start.
#include "hit/hit.glsl"
#include "hit/random.glsl"
#include "hit/trace.glsl"

layout(local_size_x = kRayGroupSize) in;

// The words of each instance.
const uint kLeaving = 0u;
const uint kMeetsFromHit = 1u;
const uint kMeetsFromUnits = 2u;
const uint kMeetsFromRayOrigin = 3u;
const uint kLargestClearance = 4u;  // the bits of a float
const uint kLargestUnits = 5u;
const uint kWords = 6u;

const float kLeastCosine = 1e-3;

// Wächter and Binder, "A Fast and Robust Method for Avoiding Self-Intersection" (Ray Tracing Gems, chapter 6): 256 units
// in the last place, or 2^-16 near 0.
vec3 offsetByUnits(vec3 position, vec3 n) {
    ivec3 offset = ivec3(256.0 * n);
    vec3 stepped = intBitsToFloat(floatBitsToInt(position) + mix(offset, -offset, lessThan(position, vec3(0.0))));
    return mix(stepped, position + n / 65536.0, lessThan(abs(position), vec3(1.0 / 32.0)));
}

// Returns whether a ray meets the triangle of `record`. Every candidate counts, even hidden ones. No point of
// the triangle is farther from the origin than `reach`.
bool meets(TracedHit record, vec3 origin, vec3 direction, float reach) {
    rayQueryEXT query;
    rayQueryInitializeEXT(query, sceneTlas, gl_RayFlagsNoOpaqueEXT | gl_RayFlagsSkipAABBEXT, 0xFFu,
                          origin, 0.0, direction, reach);
    bool found = false;
    while (rayQueryProceedEXT(query)) {
        uint geometry = uint(rayQueryGetIntersectionInstanceCustomIndexEXT(query, false) +
                             rayQueryGetIntersectionGeometryIndexEXT(query, false));
        uint primitive = uint(rayQueryGetIntersectionPrimitiveIndexEXT(query, false));
        found = found || (geometry == record.geometry && primitive == record.primitive);
    }
    return found;
}

void count(uint place, bool counted) {
    if (counted) {
        atomicAdd(GLINT_FRAME.counters.data[place], 1u);
    }
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= GLINT_FRAME.width) {
        return;
    }
    RayRecord ray = GLINT_FRAME.rays.data[index];
    TracedHit record = traceRay(ray, gl_RayFlagsCullBackFacingTrianglesEXT);
    if (record.geometry == kMissGeometry) {
        return;
    }
    GeometryRecord geometry = GLINT_FRAME.geometries.data[record.geometry];
    Hit hit = fetchHit(geometry, record.primitive, record.barycentrics, ray.direction, 0.0, index,
                       GLINT_PRIMARY_FEATURES(geometry));
    vec3 tangent;
    vec3 bitangent;
    buildBasis(hit.geometricNormal, tangent, bitangent);
    uint base = geometry.instanceIndex * kWords;
    atomicMax(GLINT_FRAME.counters.data[base + kLargestClearance], floatBitsToUint(hit.clearance));

    for (uint i = 0u; i < 2u; ++i) {
        float side = i == 0u ? 1.0 : -1.0;
        // All magnitudes of cosines are equally likely.
        float cosine = exp2(randomUnit(index, i, GLINT_FRAME.seed, 0u) * log2(kLeastCosine));
        float angle = 6.2831853 * randomUnit(index, i, GLINT_FRAME.seed, 1u);
        float sine = sqrt(1.0 - cosine * cosine);
        vec3 direction = sine * cos(angle) * tangent + sine * sin(angle) * bitangent +
                         side * cosine * hit.geometricNormal;
        vec3 byUnits = offsetByUnits(hit.position, side * hit.geometricNormal);
        atomicMax(GLINT_FRAME.counters.data[base + kLargestUnits], floatBitsToUint(distance(byUnits, hit.position)));
        float size = length(hit.edges[0]) + length(hit.edges[1]);
        count(base + kLeaving, true);
        count(base + kMeetsFromHit, meets(record, hit.position, direction, 2.0 * size));
        count(base + kMeetsFromUnits,
              meets(record, byUnits, direction, 2.0 * (size + distance(byUnits, hit.position))));
        count(base + kMeetsFromRayOrigin,
              meets(record, rayOrigin(hit, direction), direction, 2.0 * (size + hit.clearance)));
    }
}
