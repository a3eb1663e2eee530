// Dispatches over lists of rays and hits.
#include "hit/bindings.glsl"

// Workgroups for `count` threads of kRayGroupSize, in two dimensions where one does not hold them.
DispatchArguments listDispatch(uint count) {
    uint groups = (count + kRayGroupSize - 1u) / kRayGroupSize;
    uint rows = (groups + kMaxRayGroupsX - 1u) / kMaxRayGroupsX;
    return DispatchArguments(min(groups, kMaxRayGroupsX), rows, rows > 0u ? 1u : 0u, count);
}

// Index of this thread in such a dispatch; it may be beyond the list.
uint listIndex() {
    return (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * kRayGroupSize + gl_LocalInvocationIndex;
}

// Bucket of a hit: 0 for a miss, 1 + shader ID otherwise. A hit with an ID that no case has goes to the misses, whose
// pass shows it in an error colour and counts it.
uint bucketOf(HitRecord hit) {
    if (hit.geometry == kMissGeometry) {
        return 0u;
    }
    uint shaderId = GLINT_FRAME.geometries.data[hit.geometry].shaderId;
    return shaderId < GLINT_CASE_COUNT ? 1u + shaderId : 0u;
}
