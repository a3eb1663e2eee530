#version 460
// Checks the order of the hits on the device. Buckets must lie side by side and hold as many hits as there are rays,
// and each of their slots must have a hit of that bucket that no other slot has. Then no hit is lost, because there are
// no more hits than slots. Any number of threads works: each takes every threadCount-th bucket and slot.
#include "hit/list.glsl"
#include "order/bucket.glsl"
#if GLINT_HITS_IN_SAMPLES
#include "hit/samples.glsl"
#endif

GLINT_RAY_WORKGROUP

void report(bool wrong) {
    if (wrong) {
        atomicAdd(GLINT_FRAME.counters.data[kCounterOrderErrors], 1u);
    }
}

struct Bucket {
    uint count;
    uint begin;
    uint cursor;
};

Bucket loadBucket(uint index) {
    return Bucket(GLINT_FRAME.bucketCounts.data[index], GLINT_FRAME.bucketBegins.data[index],
                  GLINT_FRAME.bucketCursors.data[index]);
}

// Returns where the bucket after this one begins.
uint endOfBucket(Bucket bucket) {
    uint alignment = GLINT_FRAME.bucketAlignment;
    return bucket.begin + (bucket.count + alignment - 1u) / alignment * alignment;
}

void checkBucket(uint index, uint slotCount) {
    Bucket bucket = loadBucket(index);
    report(index == 0u && bucket.begin != 0u);
    report(bucket.cursor != bucket.count);
    bool last = index + 1u == GLINT_FRAME.bucketCount;
    uint next = last ? slotCount : GLINT_FRAME.bucketBegins.data[index + 1u];
    report(endOfBucket(bucket) != next);
    report(GLINT_FRAME.bucketDispatch.data[index].elementCount != bucket.count);
}

void checkSum(uint rayCount) {
    uint sum = 0u;
    for (uint i = 0u; i < GLINT_FRAME.bucketCount; ++i) {
        sum += GLINT_FRAME.bucketCounts.data[i];
    }
    report(sum != rayCount);
}

// Returns the bucket of a slot: the last bucket that begins there or before it. Other buckets that begin at the same
// slot are empty.
uint bucketOfSlot(uint slot) {
    uint found = 0u;
    uint end = GLINT_FRAME.bucketCount;
    while (end - found > 1u) {
        uint middle = (found + end) / 2u;
        if (GLINT_FRAME.bucketBegins.data[middle] <= slot) {
            found = middle;
        } else {
            end = middle;
        }
    }
    return found;
}

// Returns whether an earlier call was given the same hit.
bool isVisited(uint hit) {
    uint bit = 1u << (hit & 31u);
    return (atomicOr(GLINT_FRAME.visitedHits.data[hit >> 5u], bit) & bit) != 0u;
}

void checkSlot(uint slot, uint rayCount) {
    uint hit = GLINT_FRAME.orderedHits.data[slot];
    uint index = bucketOfSlot(slot);
    Bucket bucket = loadBucket(index);
    if (slot - bucket.begin >= bucket.count) {
        report(hit != kNoHit);
    } else if (hit >= rayCount) {
        report(true);
    } else {
        report(bucketOfGeometry(storedGeometry(hit)) != index);
        report(isVisited(hit));
    }
}

void main() {
    uint thread = listIndex();
    uint threadCount = gl_NumWorkGroups.x * gl_NumWorkGroups.y * kRayGroupSize;
    uint rayCount = GLINT_FRAME.rayDispatch.data[0].elementCount;
    uint slotCount = GLINT_FRAME.bucketDispatch.data[GLINT_FRAME.bucketCount].elementCount;
    if (thread == 0u) {
        checkSum(rayCount);
    }
    for (uint index = thread; index < GLINT_FRAME.bucketCount; index += threadCount) {
        checkBucket(index, slotCount);
    }
    for (uint slot = thread; slot < slotCount; slot += threadCount) {
        checkSlot(slot, rayCount);
    }
}
