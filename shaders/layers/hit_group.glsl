// Numbers the groups of hits that are shaded together, for layers.
#include "hit/bindings.glsl"
#include "hit/stage.glsl"

#if GLINT_LAYER_GROUPS && !GLINT_RAY_GENERATION
#include "generated/tallies.glsl"
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_arithmetic : require

// Returns how many distinct values the active threads of the subgroup have. All of them must call.
uint distinctInSubgroup(uint value) {
    const uint kNone = 0xFFFFFFFFu;
    uint found = 0u;
    uint waiting = value;
    uint next = subgroupMin(waiting);
    while (next != kNone) {
        ++found;
        waiting = waiting == next ? kNone : waiting;
        next = subgroupMin(waiting);
    }
    return found;
}

// All threads that shade a hit must call. `shaderId` is below 0xFFFFFFFF.
void noteHitGroup(uint target, uint shaderId) {
    GLINT_TALLY_WORKGROUP(target, gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x);
    GLINT_TALLY_CASES(target, distinctInSubgroup(min(shaderId, 0xFFFFFFFEu)));
}
#endif
