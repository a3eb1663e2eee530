// Exclusive sums over a workgroup of GLINT_SCAN_GROUP_SIZE threads; all of them must call. The module defines the size
// before it includes this file. GLINT_SCAN_SHUFFLES is 1 if a module may ask devices for shuffles:
// subgroupInclusiveAdd() must handle missing threads, and an NVIDIA driver (580.159) turns it into a function call with
// ten shuffles.
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#if GLINT_SCAN_SHUFFLES
#extension GL_KHR_shader_subgroup_shuffle_relative : require
#endif

// The sum of each subgroup. Subgroups have at least 4 threads.
shared uint scanSums[GLINT_SCAN_GROUP_SIZE / 4u];

// Returns this thread's number in the order of the scan. In it the threads of a subgroup are consecutive, which is not
// guaranteed for gl_LocalInvocationIndex.
uint scanThread() {
    return gl_SubgroupID * gl_SubgroupSize + gl_SubgroupInvocationID;
}

// Returns the sum of the values of the subgroup's threads up to this one.
uint scanSubgroup(uint value) {
#if GLINT_SCAN_SHUFFLES
    for (uint distance = 1u; distance < gl_SubgroupSize; distance *= 2u) {
        uint below = subgroupShuffleUp(value, distance);
        value += gl_SubgroupInvocationID >= distance ? below : 0u;
    }
    return value;
#else
    return subgroupInclusiveAdd(value);
#endif
}

// Returns the sum of the values of threads before this one; `total` receives the sum of all. Every subgroup must be
// full.
//
// In a module of 448 threads that called this once, an NVIDIA driver (580.159) inlined it and then gave wrong sums of
// subgroupAdd(). With 384, 512 or 1024 threads, or with two calls, the sums were right. bench_ordering checks the
// results that it times.
uint scanWorkgroup(uint value, out uint total) {
    uint inclusive = scanSubgroup(value);
    barrier();  // waits for threads that still read the sums of the last call
    if (gl_SubgroupInvocationID == gl_SubgroupSize - 1u) {
        scanSums[gl_SubgroupID] = inclusive;
    }
    barrier();
    uint before = inclusive - value;
    total = 0u;
    for (uint first = 0u; first < gl_NumSubgroups; first += gl_SubgroupSize) {
        uint subgroup = first + gl_SubgroupInvocationID;
        uint sum = subgroup < gl_NumSubgroups ? scanSums[subgroup] : 0u;
        before += subgroupAdd(subgroup < gl_SubgroupID ? sum : 0u);
        total += subgroupAdd(sum);
    }
    return before;
}
