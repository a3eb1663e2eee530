// Shadow rays of hits, which are traced at once or put on a list.
#include "hit/bindings.glsl"
#include "hit/count.glsl"
#include "light/ray.glsl"

struct ShadowRay {
    vec3 origin;
    vec3 direction;  // unit vector
    float distance;  // metres
    vec3 light;      // light that arrives if nothing is in the way
    uint sees;       // kShadow*
};

#if GLINT_SHADOWS_DEFERRED

// Returns the next slot of the list. In compute shaders it takes one atomic for the active threads of a subgroup, whose
// slots are adjacent.
uint shadowSlot() {
#if GLINT_RAY_GENERATION
    return atomicAdd(GLINT_FRAME.counters.data[kCounterShadowRays], 1u);
#else
    uvec4 lanes = subgroupBallot(true);
    uint first = 0u;
    if (subgroupElect()) {
        first = atomicAdd(GLINT_FRAME.counters.data[kCounterShadowRays], subgroupBallotBitCount(lanes));
    }
    return subgroupBroadcastFirst(first) + subgroupBallotExclusiveBitCount(lanes);
#endif
}

#endif

// Returns the light that is certain now; if shadow rays are deferred, a pass over the list adds the rest. The list has
// room, because each sample has one ray. Without the effect, nothing blocks any light.
vec3 lightOrDefer(uint target, ShadowRay shadow) {
#if !GLINT_EFFECT_SHADOW
    return shadow.light;
#elif GLINT_SHADOWS_DEFERRED
    GLINT_FRAME.shadows.data[shadowSlot()] =
        ShadowRecord(shadow.origin, target, shadow.direction, shadow.distance, shadow.light, shadow.sees);
    return vec3(0.0);
#else
    bool visible = lightArrivesTo(shadow.sees, shadow.origin, shadow.direction, shadow.distance, shadow.light);
    countRays(kEffectShadow, 1u, visible ? 1u : 0u);
    return visible ? shadow.light : vec3(0.0);
#endif
}
