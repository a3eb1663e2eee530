// Numbers elements in groups, with one atomic for each group that a subgroup has. Before it includes this file, a
// module defines GLINT_COUNT_OF(group), the counter of a group.
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_arithmetic : require

// The group of a thread without an element. It is above every other group.
const uint kNoGroup = 0xFFFFFFFFu;

// Adds the elements of a subgroup to the counters of their groups. Returns how many elements this thread's group had
// before its own. All threads of the subgroup must call; conditions are equal in all of them.
uint numberInGroup(uint group) {
    uint number = 0u;
    uint next = subgroupMin(group);
    while (next != kNoGroup) {
        bool added = group == next;
        uvec4 lanes = subgroupBallot(added);
        uint first = 0u;
        if (subgroupElect()) {
            first = atomicAdd(GLINT_COUNT_OF(next), subgroupBallotBitCount(lanes));
        }
        first = subgroupBroadcastFirst(first) + subgroupBallotExclusiveBitCount(lanes);
        number = added ? first : number;
        group = added ? kNoGroup : group;
        next = subgroupMin(group);
    }
    return number;
}
