// What follows from the counts of the buckets: where each begins, so that the order of buckets does not depend on timing,
// and the indirect arguments of its shading.
#include "hit/list.glsl"

// Slots that a bucket takes up: the next one begins behind them.
uint roomOf(uint count) {
    uint alignment = GLINT_FRAME.bucketAlignment;
    return (count + alignment - 1u) / alignment * alignment;
}

void storeBucket(uint bucket, uint begin, uint count) {
    GLINT_FRAME.bucketBegins.data[bucket] = begin;
    GLINT_FRAME.bucketDispatch.data[bucket] = listDispatch(count, kRayGroupSize);
}

// Slots between the end of a bucket and the next begin hold no hit.
void clearGap(uint begin, uint count) {
    uint end = begin + roomOf(count);
    for (uint slot = begin + count; slot < end; ++slot) {
        GLINT_FRAME.orderedHits.data[slot] = kNoHit;
    }
}

// Behind the arguments of the buckets are those over all slots.
void storeSlotCount(uint slots) {
    GLINT_FRAME.bucketDispatch.data[GLINT_FRAME.bucketCount] = listDispatch(slots, kRayGroupSize);
}
