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
#if GLINT_FIRST_SHADOW_RAYS == 0
    countRays(kEffectShadow, counts.rays, counts.misses);
#else
    if (pushed.shadowRound > 0u) {
        return;
    }
#endif
    if (kCountsLight) {
        addToCounter(counterOf(kEffectShadow, kRayFacing), counts.facing);
        addToCounter(counterOf(kEffectShadow, kRayRange), counts.range);
        addToCounter(counterOf(kEffectShadow, kRayCone), counts.cone);
    }
}

// The points of a light that a sample takes: one, unless it is an area light.
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

// A shadow ray of a surface.
struct SurfaceShadow {
    vec3 direction;  // unit vector
    float distance;  // metres
    vec3 light;      // that the surface scatters towards its viewer if nothing is in the way
    uint sees;       // kShadow*
#if GLINT_EMISSIVE_LIGHTS && GLINT_SHADOW_GLASS
    vec3 pastGlass;  // the same if the light has passed glass
#endif
};

SurfaceShadow surfaceShadow(vec3 direction, float distance, vec3 light, uint sees) {
#if GLINT_EMISSIVE_LIGHTS && GLINT_SHADOW_GLASS
    return SurfaceShadow(direction, distance, light, sees, light);
#else
    return SurfaceShadow(direction, distance, light, sees);
#endif
}

#if GLINT_TRACER == 1 || GLINT_RAY_GENERATION

// Returns the light that arrives.
vec3 traceShadow(Hit hit, SurfaceShadow ray, inout ShadowCounts counts) {
#if GLINT_EMISSIVE_LIGHTS && GLINT_SHADOW_GLASS
    vec3 arriving = vec3(1.0);
    bool visible = lightArrives(rayOrigin(hit, ray.direction), ray.direction, ray.distance, arriving);
    ray.light = (lightPassedGlass ? ray.pastGlass : ray.light) * arriving;
#else
    bool visible = lightArrivesTo(ray.sees, rayOrigin(hit, ray.direction), ray.direction, ray.distance, ray.light);
#endif
    counts.rays += 1u;
    counts.misses += visible ? 1u : 0u;
    return visible ? ray.light : vec3(0.0);
}

#endif

#if GLINT_FIRST_SHADOW_RAYS > 0

const uint kFirstShadowRays = GLINT_FIRST_SHADOW_RAYS;

// A shadow ray of a first hit in memory. It sees what stops a ray to a light, or what stops one of a lobe.
struct WaitingShadow {
    vec3 direction;
    uint distance31_sees1;  // a distance has no sign: kShadowOfLight or kShadowOfShared stands there
    vec3 light;
#if GLINT_EMISSIVE_LIGHTS && GLINT_SHADOW_GLASS
    vec3 pastGlass;
#endif
};

// The rays of a round: first those of all pixels of a band with the lowest numbers, then those with the next ones.
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer FirstShadowArray { WaitingShadow data[]; };

// Returns the place of a ray of the round.
uint firstShadowPlace(uint pixelOfBand, uint ray) {
    return ray * GLINT_FRAME.width * (GLINT_FRAME.endRow - GLINT_FRAME.firstRow) + pixelOfBand;
}

void storeWaiting(uint place, SurfaceShadow ray) {
    uint distance = floatBitsToUint(ray.distance) | ray.sees << 31u;
#if GLINT_EMISSIVE_LIGHTS && GLINT_SHADOW_GLASS
    WaitingShadow waiting = WaitingShadow(ray.direction, distance, ray.light, ray.pastGlass);
#else
    WaitingShadow waiting = WaitingShadow(ray.direction, distance, ray.light);
#endif
    FirstShadowArray(GLINT_FRAME.shadows).data[place] = waiting;
}

SurfaceShadow waitingShadow(uint place) {
    WaitingShadow waiting = FirstShadowArray(GLINT_FRAME.shadows).data[place];
    SurfaceShadow ray = surfaceShadow(waiting.direction, uintBitsToFloat(waiting.distance31_sees1 & 0x7FFFFFFFu),
                                      waiting.light, waiting.distance31_sees1 >> 31u);
#if GLINT_EMISSIVE_LIGHTS && GLINT_SHADOW_GLASS
    ray.pastGlass = waiting.pastGlass;
#endif
    return ray;
}

// All rays wait for a pass of their own (first/first_shadows.comp), so that the code of a material and that of a
// traversal do not share registers.
vec3 traceWaiting(Hit hit, ShadowCounts counts) {
    GLINT_FRAME.firstShadowCounts.data[hit.target - GLINT_FRAME.bandFirst] = counts.rays;
    return vec3(0.0);
}

vec3 sendShadow(Hit hit, SurfaceShadow ray, inout ShadowCounts counts) {
    uint place = counts.rays - kFirstShadowRays * pushed.shadowRound;
    if (place < kFirstShadowRays) {
        storeWaiting(firstShadowPlace(hit.target - GLINT_FRAME.bandFirst, place), ray);
    }
    counts.rays += 1u;
    return vec3(0.0);
}

#elif GLINT_RAY_GENERATION

// With each ray that it sends, a ray generation shader saves all that it needs afterwards. So rays wait until the
// material is no longer needed.
const uint kMostWaiting = 16u;
SurfaceShadow waitingShadows[kMostWaiting];
uint waitingCount = 0u;

// Returns the light of the rays that wait. The last is traced first: a driver unrolls a loop that counts up to an
// array's length, and a copy of the traversal for each ray took Mesa's lavapipe 97 s to compile, where this takes 4 s.
vec3 traceWaiting(Hit hit, inout ShadowCounts counts) {
    vec3 sum = vec3(0.0);
    while (waitingCount > 0u) {
        waitingCount -= 1u;
        sum += traceShadow(hit, waitingShadows[waitingCount], counts);
    }
    return sum;
}

// Returns light of this ray or of earlier ones. traceWaiting() returns the rest.
vec3 sendShadow(Hit hit, SurfaceShadow ray, inout ShadowCounts counts) {
    vec3 earlier = waitingCount == kMostWaiting ? traceWaiting(hit, counts) : vec3(0.0);
    waitingShadows[waitingCount] = ray;
    waitingCount += 1u;
    return earlier;
}

#else

vec3 traceWaiting(Hit hit, inout ShadowCounts counts) {
    return vec3(0.0);
}

vec3 sendShadow(Hit hit, SurfaceShadow ray, inout ShadowCounts counts) {
    return traceShadow(hit, ray, counts);
}

#endif
