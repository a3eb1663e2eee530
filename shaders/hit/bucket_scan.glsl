// Where each bucket begins, by an exclusive scan of the counts, so that the order of buckets does not depend on timing;
// and the indirect arguments of each bucket's shading. For a workgroup of GLINT_SCAN_GROUP_SIZE threads, which the module
// says before it includes this file, and all of which call.
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_arithmetic : require

#include "hit/list.glsl"

shared uint scanSums[GLINT_SCAN_GROUP_SIZE];  // by subgroup: there are no more of them than threads

// This thread's number in the order that scans take. A subgroup's threads follow each other in it, which nothing says
// of gl_LocalInvocationIndex.
uint scanThread() {
    return gl_SubgroupID * gl_SubgroupSize + gl_SubgroupInvocationID;
}

// Sum of the values of threads before this one; `total` is that of all.
uint scanWorkgroup(uint value, out uint total) {
    uint before = subgroupExclusiveAdd(value);
    uint sum = subgroupAdd(value);
    barrier();  // who reads the sums of the call before
    if (subgroupElect()) {
        scanSums[gl_SubgroupID] = sum;
    }
    barrier();
    total = 0u;
    for (uint i = 0u; i < gl_NumSubgroups; ++i) {
        before += i < gl_SubgroupID ? scanSums[i] : 0u;
        total += scanSums[i];
    }
    return before;
}

// Slots between the end of a bucket and the next begin hold no hit.
void clearGap(uint begin, uint end) {
    for (uint slot = begin; slot < end; ++slot) {
        GLINT_FRAME.orderedHits.data[slot] = kNoHit;
    }
}

// Counts may come from other workgroups of the same dispatch, which have added them by atomics: they are read so.
void scanBuckets() {
    uint carry = 0u;
    uint alignment = GLINT_FRAME.bucketAlignment;
    for (uint first = 0u; first < GLINT_FRAME.bucketCount; first += GLINT_SCAN_GROUP_SIZE) {
        uint bucket = first + scanThread();
        bool inside = bucket < GLINT_FRAME.bucketCount;
        uint count = inside ? atomicAdd(GLINT_FRAME.bucketCounts.data[bucket], 0u) : 0u;
        uint room = (count + alignment - 1u) / alignment * alignment;
        uint total;
        uint begin = carry + scanWorkgroup(room, total);
        if (inside) {
            GLINT_FRAME.bucketBegins.data[bucket] = begin;
            GLINT_FRAME.bucketCursors.data[bucket] = begin;
            GLINT_FRAME.bucketDispatch.data[bucket] = listDispatch(count, kRayGroupSize);
            clearGap(begin + count, begin + room);
        }
        carry += total;
    }
    if (scanThread() == 0u) {
        GLINT_FRAME.bucketDispatch.data[GLINT_FRAME.bucketCount] = listDispatch(carry, kRayGroupSize);
    }
}
