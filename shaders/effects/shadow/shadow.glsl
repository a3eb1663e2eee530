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
    uint facing;  // lights that the surface faces away from or does not scatter
    uint range;
    uint cone;
};

// Counts the reason why a light needs no ray.
void countGate(LightSample centre, bool reaches, inout ShadowCounts counts) {
    counts.range += centre.gate == kRayRange ? 1u : 0u;
    counts.cone += centre.gate == kRayCone ? 1u : 0u;
    counts.facing += centre.gate == kRaySent && !reaches ? 1u : 0u;
}

void reportShadows(ShadowCounts counts) {
    countRays(kEffectShadow, counts.rays, counts.misses);
    if (GLINT_FRAME.countsLight != 0u) {
        addToCounter(counterOf(kEffectShadow, kRayFacing), counts.facing);
        addToCounter(counterOf(kEffectShadow, kRayRange), counts.range);
        addToCounter(counterOf(kEffectShadow, kRayCone), counts.cone);
    }
}

// A share of a light: of each colour if glass may stand before it, or counted.
#if GLINT_SHADOW_GLASS
#define LightShare vec3
#define LightSum vec3
#else
#define LightShare float
#define LightSum uint
#endif

// The visible share of a light's solid angle. A light without a size is visible or not.
LightShare visibleShare(Hit hit, HostLight light, LightSample centre, uint index, inout ShadowCounts counts) {
    vec3 share = vec3(1.0);
    if (!hostLightHasSize(light)) {
        bool visible = lightArrives(rayOrigin(hit, centre.direction), centre.direction, centre.distance, share);
        counts.rays += 1u;
        counts.misses += visible ? 1u : 0u;
        return visible ? LightShare(share) : LightShare(0.0);
    }
    float side = dot(hit.geometricNormal, centre.direction);
    LightSum seen = LightSum(0u);
    for (uint i = 0u; i < GLINT_FRAME.shadowSamples; ++i) {
        uint number = GLINT_FRAME.sampleIndex * GLINT_FRAME.shadowSamples + i;
        vec2 u = sequencePair(hit.target, number, GLINT_FRAME.seed, kPairShadow + index);
        LightSample point = hostSampleLightPoint(light, centre, u);
        // The surface itself hides the part of the light that is below it.
        if (point.distance <= 0.0) {
            seen += LightSum(1u);
        } else if (side * dot(hit.geometricNormal, point.direction) > 0.0) {
            share = vec3(1.0);
            bool visible = lightArrives(rayOrigin(hit, point.direction), point.direction, point.distance, share);
            counts.rays += 1u;
            counts.misses += visible ? 1u : 0u;
            seen += visible ? LightSum(share) : LightSum(0u);
        }
    }
    return LightShare(seen) / float(GLINT_FRAME.shadowSamples);
}
