// Dispatches over lists of rays and hits.
#include "hit/bindings.glsl"
#include "hit/stage.glsl"

// Returns the arguments for one workgroup for every `groupSize` elements, in two dimensions if one is not enough, and
// for one ray generation thread for each element.
DispatchArguments listDispatch(uint count, uint groupSize) {
    uint groups = (count + (groupSize - 1u)) / groupSize;
    uint rows = (groups + (kMaxRayGroupsX - 1u)) / kMaxRayGroupsX;
    uint any = rows > 0u ? 1u : 0u;
    return DispatchArguments(min(groups, kMaxRayGroupsX), rows, any, count, count, any, any, 0u);
}

// Returns the index of this thread in such a dispatch. It may be beyond the list.
uint listIndex() {
#if GLINT_RAY_GENERATION
    return gl_LaunchIDEXT.x;
#else
    return (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * kRayGroupSize + gl_LocalInvocationIndex;
#endif
}
