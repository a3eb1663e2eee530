// Derives from the counts of the buckets the begin of each, so that the order of buckets does not depend on timing, and
// the indirect arguments for shading it.
#include "hit/list.glsl"

// The slots that a bucket takes up; the next bucket begins behind them.
uint roomOf(uint count) {
    uint alignment = GLINT_FRAME.bucketAlignment;
    return (count + alignment - 1u) / alignment * alignment;
}

void storeBucket(uint bucket, uint begin, uint count) {
    GLINT_FRAME.bucketBegins.data[bucket] = begin;
    GLINT_FRAME.bucketDispatch.data[bucket] = listDispatch(count, kRayGroupSize);
}

// Marks the slots between the end of a bucket and the next begin as empty.
void clearGap(uint begin, uint count) {
    uint end = begin + roomOf(count);
    for (uint slot = begin + count; slot < end; ++slot) {
        GLINT_FRAME.orderedHits.data[slot] = kNoHit;
    }
}

// The arguments for all slots stand behind those of the buckets.
void storeSlotCount(uint slots) {
    GLINT_FRAME.bucketDispatch.data[GLINT_FRAME.bucketCount] = listDispatch(slots, kRayGroupSize);
}
