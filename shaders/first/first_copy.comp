#version 460
// Writes the numbers of pixels in the order of their buckets.
#define GLINT_FIRST_COUNTERS GLINT_FRAME.bucketCursors
#include "first/first_order.glsl"

#if GLINT_FIRST_LOCAL
shared uint blockBegins[kBuckets];
#endif

void main() {
    uint elements = firstElements();
    OrderedArray slots = GLINT_FRAME.orderedHits;
    uint buckets[kFirstPixelsOfThread];
    for (uint k = 0u; k < kFirstPixelsOfThread; ++k) {
        uint element = firstElement(k);
        buckets[k] = element < elements ? storedKey(element) : kNoGroup;
    }
    uint numbers[kFirstPixelsOfThread];
#if GLINT_FIRST_LOCAL
    clearBlock();
#endif
    for (uint k = 0u; k < kFirstPixelsOfThread; ++k) {
        numbers[k] = numberInGroup(buckets[k]);
    }
#if GLINT_FIRST_LOCAL
    barrier();
    for (uint bucket = gl_LocalInvocationIndex; bucket < kBuckets; bucket += kFirstGroupSize) {
        uint count = blockCounts[bucket];
        if (count > 0u) {
            uint before = atomicAdd(GLINT_FIRST_COUNTERS.data[bucket], count);
            blockBegins[bucket] = GLINT_FRAME.bucketBegins.data[bucket] + before;
        }
    }
    barrier();
#endif
    for (uint k = 0u; k < kFirstPixelsOfThread; ++k) {
        if (buckets[k] != kNoGroup) {
#if GLINT_FIRST_LOCAL
            uint begin = blockBegins[buckets[k]];
#else
            uint begin = GLINT_FRAME.bucketBegins.data[buckets[k]];
#endif
            slots.data[begin + numbers[k]] = firstElement(k);
        }
    }
}
