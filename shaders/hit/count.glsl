// Counts of what effects do. In compute shaders one atomic a subgroup, and all threads of it call; ray generation
// shaders, which may lack subgroup operations, add one by one.
#include "hit/bindings.glsl"
#include "hit/stage.glsl"

#if !GLINT_RAY_GENERATION
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#endif

// Place of a count (kRay*, kCount*) of an effect.
uint counterOf(uint effect, uint kind) {
    return kCounterEffects + kCountsOfEffect * uint(findLSB(effect)) + kind;
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

// Adds the number of threads that say so to a counter; returns the first of the counts given to this subgroup.
uint countInSubgroup(uint counter, bool counted) {
    uvec4 ballot = subgroupBallot(counted);
    uint base = 0u;
    if (subgroupElect()) {
        uint total = subgroupBallotBitCount(ballot);
        if (total > 0u) {
            base = atomicAdd(GLINT_FRAME.counters.data[counter], total);
        }
    }
    return subgroupBroadcastFirst(base) + subgroupBallotExclusiveBitCount(ballot);
}

// Adds one to the count `kind` of each thread that says so, with an atomic for each that the subgroup has.
void countKinds(uint effect, bool counted, uint kind) {
    const uint kNone = 0xFFFFFFFFu;
    uint waiting = counted ? kind : kNone;
    uint next = subgroupMin(waiting);
    while (next != kNone) {
        countInSubgroup(counterOf(effect, next), waiting == next);
        waiting = waiting == next ? kNone : waiting;
        next = subgroupMin(waiting);
    }
}

#endif

// Rays of an effect that are traced on the spot, and those of them that met nothing. All threads of a subgroup that are
// here call.
void countRays(uint effect, uint rays, uint misses) {
    if (GLINT_FRAME.countsLight != 0u) {
        addToCounter(counterOf(effect, kRaySent), rays);
        addToCounter(counterOf(effect, kCountMisses), misses);
        addToCounter(counterOf(effect, kCountHits), rays - misses);
    }
}
