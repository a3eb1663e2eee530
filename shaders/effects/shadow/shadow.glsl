// The effect shadow: how much of a light reaches a primary surface. Hits of rays send one shadow ray each
// (hit/shade.glsl).
#include "hit/count.glsl"
#include "hit/hit.glsl"
#include "light/ray.glsl"
#include "hit/sequence.glsl"
#include "host/lights.glsl"

// The pair of dimensions of the sequence for the first light. Each further light has the next pair.
const uint kPairShadow = 64u;

// The counts of one surface's rays.
struct ShadowCounts {
    uint rays;
    uint misses;  // rays that reached the light
    uint facing;  // points of lights that the surface faces away from or does not scatter
    uint range;
    uint cone;
};

// Returns whether the light may reach the surface. If not, counts the reason.
bool passesGate(LightSample centre, inout ShadowCounts counts) {
    counts.range += centre.gate == kRayRange ? 1u : 0u;
    counts.cone += centre.gate == kRayCone ? 1u : 0u;
    return centre.gate == kRaySent;
}

void reportShadows(ShadowCounts counts) {
    countRays(kEffectShadow, counts.rays, counts.misses);
    if (GLINT_FRAME.countsLight != 0u) {
        addToCounter(counterOf(kEffectShadow, kRayFacing), counts.facing);
        addToCounter(counterOf(kEffectShadow, kRayRange), counts.range);
        addToCounter(counterOf(kEffectShadow, kRayCone), counts.cone);
    }
}

// The points of a light that a sample takes: one of a light without a size.
uint lightPointCount(HostLight light) {
    return hostLightHasSize(light) ? GLINT_FRAME.shadowSamples : 1u;
}

// Point number `point` of the light number `index`.
LightSample lightPoint(Hit hit, HostLight light, LightSample centre, uint index, uint point) {
    if (!hostLightHasSize(light)) {
        return centre;
    }
    uint number = GLINT_FRAME.sampleIndex * GLINT_FRAME.shadowSamples + point;
    return hostSampleLightPoint(light, centre,
                                sequencePair(hit.target, number, GLINT_FRAME.seed, kPairShadow + index));
}

// Returns how much of `light`, which a surface scatters from a point of a light, arrives. Within the light nothing
// blocks it.
vec3 visibleLight(Hit hit, LightSample point, vec3 light, inout ShadowCounts counts) {
    if (luminance(light) <= 0.0) {
        counts.facing += 1u;
        return vec3(0.0);
    }
    if (point.distance <= 0.0) {
        return light;
    }
    bool visible = lightArrives(rayOrigin(hit, point.direction), point.direction, point.distance, light);
    counts.rays += 1u;
    counts.misses += visible ? 1u : 0u;
    return visible ? light : vec3(0.0);
}
