// Counts the work of effects. Each count has kCounterCopies counters, and adjacent workgroups add to different ones,
// because a GPU executes atomics on one address one after the other. The host sums them up.
//
// Compute shaders use one atomic for each subgroup, and all of its threads must call. Ray generation shaders, which may
// lack subgroup operations, add one by one.
#include "hit/bindings.glsl"
#include "hit/stage.glsl"

#if !GLINT_RAY_GENERATION
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#endif

// The copy that this thread adds to. It is equal in all threads of a subgroup.
uint counterCopy() {
#if GLINT_RAY_GENERATION
    return (gl_LaunchIDEXT.x / kRayGroupSize + gl_LaunchIDEXT.y) % kCounterCopies;
#else
    return (gl_WorkGroupID.x + gl_WorkGroupID.y) % kCounterCopies;
#endif
}

// The index of a count (kRay*, kCount*) of an effect.
uint counterOf(uint effect, uint kind) {
    uint number = GLINT_EFFECT_COUNT * counterCopy() + uint(findLSB(effect));
    return kCounterEffects + kCountsOfEffect * number + kind;
}

void addToCounter(uint counter, uint amount) {
#if GLINT_RAY_GENERATION
    if (amount > 0u) {
        atomicAdd(GLINT_FRAME.counters.data[counter], amount);
    }
#else
    uint total = subgroupAdd(amount);
    if (subgroupElect() && total > 0u) {
        atomicAdd(GLINT_FRAME.counters.data[counter], total);
    }
#endif
}

#if !GLINT_RAY_GENERATION

// Adds the number of threads whose `counted` is true.
void countThreads(uint counter, bool counted) {
    uint total = subgroupBallotBitCount(subgroupBallot(counted));
    if (subgroupElect() && total > 0u) {
        atomicAdd(GLINT_FRAME.counters.data[counter], total);
    }
}

// Adds one to the count `kind` of each thread whose `counted` is true, with one atomic for each kind in the subgroup.
void countKinds(uint effect, bool counted, uint kind) {
    const uint kNone = 0xFFFFFFFFu;
    uint waiting = counted ? kind : kNone;
    uint next = subgroupMin(waiting);
    while (next != kNone) {
        countThreads(counterOf(effect, next), waiting == next);
        waiting = waiting == next ? kNone : waiting;
        next = subgroupMin(waiting);
    }
}

#endif

// Counts the rays of an effect that are traced at once, and those of them that hit nothing. All active threads of a
// subgroup must call.
void countRays(uint effect, uint rays, uint misses) {
    if (kCountsLight) {
        addToCounter(counterOf(effect, kRaySent), rays);
        addToCounter(counterOf(effect, kCountMisses), misses);
        addToCounter(counterOf(effect, kCountHits), rays - misses);
    }
}
