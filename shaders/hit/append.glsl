// Appends the rays of a workgroup to the list side by side, so that what traces the list finds neighbours on the screen
// together, with one atomic on its length. In compute shaders.
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require

#include "hit/bindings.glsl"

shared uint appendedRays;   // of the workgroup
shared uint appendedBegin;  // of them in the list

// Slot of a thread's ray, counted in kCounterRays; undefined for a thread without one. All threads of the workgroup call.
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
