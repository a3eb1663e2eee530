// Shadow rays of hits: traced at once, or put on a list.
#include "hit/bindings.glsl"
#include "hit/count.glsl"
#include "hit/trace.glsl"

struct ShadowRay {
    vec3 origin;
    vec3 direction;  // unit
    float distance;  // metres
    vec3 light;      // what it brings if nothing is in its way
};

#if GLINT_SHADOWS_DEFERRED

// Next slot of the list: in compute shaders one atomic for the threads of a subgroup that are here, whose slots lie side
// by side.
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

// The light that is certain now; deferred, the rest comes by a pass over the list. One ray a sample: the list has room.
// Without the effect, nothing is in the way of any light.
vec3 lightOrDefer(uint target, ShadowRay shadow) {
#if !GLINT_EFFECT_SHADOW
    return shadow.light;
#elif GLINT_SHADOWS_DEFERRED
    GLINT_FRAME.shadows.data[shadowSlot()] =
        ShadowRecord(shadow.origin, target, shadow.direction, shadow.distance, shadow.light, 0u);
    return vec3(0.0);
#else
    bool visible = isVisible(shadow.origin, shadow.direction, shadow.distance);
    countRays(kEffectShadow, 1u, visible ? 1u : 0u);
    return visible ? shadow.light : vec3(0.0);
#endif
}
