// The order of first hits. Workgroups take blocks of the list, count the pixels of each bucket in shared memory, and add
// to memory with one atomic for each bucket that the block has. Pixels keep their order within a subgroup's share of a
// block, so that threads that are shaded together see neighbouring pixels. The orderings of rays' hits keep no order:
// with tile-sort an H100 took 1.4 times as long to trace the shadow rays of the same pixels.
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_arithmetic : require

#include "first/first_list.glsl"
#include "order/bucket_key.glsl"

layout(local_size_x = kFirstGroupSize) in;

const uint kBlock = kFirstGroupSize * kFirstPixelsOfThread;

// With more buckets than shared memory has room for, blocks add to memory at once.
#define GLINT_FIRST_LOCAL (GLINT_CASE_COUNT < 1024)  // kMaxLocalBuckets

// The bucket of an element beyond the list. It is above every other bucket.
const uint kNoBucket = 0xFFFFFFFFu;

#if GLINT_FIRST_LOCAL
shared uint blockCounts[kBuckets];

void clearBlock() {
    for (uint bucket = gl_LocalInvocationIndex; bucket < kBuckets; bucket += kFirstGroupSize) {
        blockCounts[bucket] = 0u;
    }
    barrier();
}
#endif

// Returns the number of the thread's element `k` in the list. Neighbouring threads have neighbouring elements.
uint firstElement(uint k) {
    return (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * kBlock + k * kFirstGroupSize +
           gl_LocalInvocationIndex;
}

// Adds the elements of a subgroup to their buckets: in shared memory, or to `words`. Returns the number that the bucket
// of this thread's element had before it. All threads of the subgroup must call.
uint addToBuckets(CounterArray words, uint bucket) {
    uint number = 0u;
    uint next = subgroupMin(bucket);
    while (next != kNoBucket) {
        bool added = bucket == next;
        uvec4 lanes = subgroupBallot(added);
        uint first = 0u;
        if (subgroupElect()) {
#if GLINT_FIRST_LOCAL
            first = atomicAdd(blockCounts[next], subgroupBallotBitCount(lanes));
#else
            first = atomicAdd(words.data[next], subgroupBallotBitCount(lanes));
#endif
        }
        first = subgroupBroadcastFirst(first) + subgroupBallotExclusiveBitCount(lanes);
        number = added ? first : number;
        bucket = added ? kNoBucket : bucket;
        next = subgroupMin(bucket);
    }
    return number;
}
