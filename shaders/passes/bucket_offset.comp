#version 460
// Ordering, second pass: where each bucket begins, by an exclusive scan, so that the order of buckets does not depend
// on timing; and the indirect arguments of each bucket's shading. One workgroup, kScanGroupSize buckets at a time.
#include "hit/list.glsl"

layout(local_size_x = kScanGroupSize) in;

shared uint partialSums[kScanGroupSize];

// Inclusive scan over the workgroup: Hillis and Steele (1986).
uint scanWorkgroup(uint value) {
    uint lane = gl_LocalInvocationIndex;
    partialSums[lane] = value;
    barrier();
    for (uint stride = 1u; stride < kScanGroupSize; stride *= 2u) {
        uint before = lane >= stride ? partialSums[lane - stride] : 0u;
        barrier();
        partialSums[lane] += before;
        barrier();
    }
    return partialSums[lane];
}

void main() {
    uint carry = 0u;
    for (uint first = 0u; first < GLINT_FRAME.bucketCount; first += kScanGroupSize) {
        uint bucket = first + gl_LocalInvocationIndex;
        bool inside = bucket < GLINT_FRAME.bucketCount;
        uint count = inside ? GLINT_FRAME.buckets.data[bucket].count : 0u;
        uint alignment = GLINT_FRAME.bucketAlignment;
        uint room = (count + alignment - 1u) / alignment * alignment;
        uint inclusive = scanWorkgroup(room);
        if (inside) {
            uint begin = carry + inclusive - room;
            GLINT_FRAME.buckets.data[bucket].begin = begin;
            GLINT_FRAME.buckets.data[bucket].cursor = begin;
            GLINT_FRAME.bucketDispatch.data[bucket] = listDispatch(count);
        }
        carry += partialSums[kScanGroupSize - 1u];
        barrier();
    }
    if (gl_LocalInvocationIndex == 0u) {
        GLINT_FRAME.bucketDispatch.data[GLINT_FRAME.bucketCount] = listDispatch(carry);
    }
}
