// The order of first hits. Workgroups take blocks of the list, count the pixels of each bucket in shared memory, and add
// to memory with one atomic for each bucket that the block has. Pixels keep their order within a subgroup's share of a
// block, so that threads that are shaded together see neighbouring pixels. The orderings of rays' hits keep no order:
// with tile-sort an H100 took 1.4 times as long to trace the shadow rays of the same pixels. Before it includes this
// file, a module defines GLINT_FIRST_COUNTERS, the words of FrameConstants to add to.
#include "first/first_list.glsl"
#include "order/bucket_key.glsl"

layout(local_size_x = kFirstGroupSize) in;

const uint kBlock = kFirstGroupSize * kFirstPixelsOfThread;

// With more buckets than shared memory has room for, blocks add to memory at once.
#define GLINT_FIRST_LOCAL (GLINT_MOST_BUCKETS <= 1024)  // kMaxLocalBuckets

#if GLINT_FIRST_LOCAL
shared uint blockCounts[kBuckets];

void clearBlock() {
    for (uint bucket = gl_LocalInvocationIndex; bucket < kBuckets; bucket += kFirstGroupSize) {
        blockCounts[bucket] = 0u;
    }
    barrier();
}

#define GLINT_COUNT_OF(bucket) blockCounts[bucket]
#else
#define GLINT_COUNT_OF(bucket) GLINT_FIRST_COUNTERS.data[bucket]
#endif
#include "order/numbering.glsl"

// Returns the number of the thread's element `k` in the list. Neighbouring threads have neighbouring elements.
uint firstElement(uint k) {
    return (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * kBlock + k * kFirstGroupSize +
           gl_LocalInvocationIndex;
}
