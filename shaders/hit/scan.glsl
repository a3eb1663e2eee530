// Exclusive sums over a workgroup of GLINT_SCAN_GROUP_SIZE threads, which the module says before it includes this file,
// and all of which call. GLINT_SCAN_SHUFFLES is 1 where a module may ask devices for shuffles: subgroupInclusiveAdd() has
// to do with threads that are missing, and an NVIDIA driver (580.159) makes a call of a function with ten shuffles of it.
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#if GLINT_SCAN_SHUFFLES
#extension GL_KHR_shader_subgroup_shuffle_relative : require
#endif

// By subgroup, which have 4 threads or more.
shared uint scanSums[GLINT_SCAN_GROUP_SIZE / 4u];

// This thread's number in the order that scans take. A subgroup's threads follow each other in it, which nothing says
// of gl_LocalInvocationIndex.
uint scanThread() {
    return gl_SubgroupID * gl_SubgroupSize + gl_SubgroupInvocationID;
}

// Sum of the values of the subgroup's threads up to this one.
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

// Sum of the values of threads before this one; `total` is that of all. Every subgroup is full.
//
// Where a module of 448 threads called this once, an NVIDIA driver (580.159), which then puts it in line, gave wrong sums
// of subgroupAdd(); with 384, 512 or 1024 threads, or two calls, right ones. bench_ordering checks what it times.
uint scanWorkgroup(uint value, out uint total) {
    uint inclusive = scanSubgroup(value);
    barrier();  // who reads the sums of the call before
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
