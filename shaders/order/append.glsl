// Appends the rays of a workgroup to the list side by side, with one atomic on the list's length. So the pass that
// traces the list finds neighbours on the screen together. For compute shaders.
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require

#include "hit/bindings.glsl"

shared uint appendedRays;   // number of rays of the workgroup
shared uint appendedBegin;  // their begin in the list

// Returns the slot of a thread's ray, and counts it in kCounterRays. The slot is undefined for a thread without a ray.
// All threads of the workgroup must call this.
uint appendedSlot(bool hasRay) {
    if (gl_LocalInvocationIndex == 0u) {
        appendedRays = 0u;
    }
    barrier();
    uvec4 lanes = subgroupBallot(hasRay);
    uint first = 0u;
    if (subgroupElect()) {
        first = atomicAdd(appendedRays, subgroupBallotBitCount(lanes));
    }
    uint number = subgroupBroadcastFirst(first) + subgroupBallotExclusiveBitCount(lanes);
    barrier();
    if (gl_LocalInvocationIndex == 0u && appendedRays > 0u) {
        appendedBegin = atomicAdd(GLINT_FRAME.counters.data[kCounterRays], appendedRays);
    }
    barrier();
    return appendedBegin + number;
}
