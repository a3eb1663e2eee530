#version 460
// Ordering, second pass: computes where each bucket begins. One workgroup handles kScanGroupSize buckets at a time. The
// ordering tile-sort has no such pass: each workgroup of its last pass does the same for itself.
#define GLINT_SCAN_GROUP_SIZE kScanGroupSize
#define GLINT_SCAN_SHUFFLES 0
#include "order/bucket_scan.glsl"
#include "order/scan.glsl"

layout(local_size_x = kScanGroupSize) in;

void main() {
    uint slots = 0u;
    for (uint first = 0u; first < GLINT_FRAME.bucketCount; first += kScanGroupSize) {
        uint bucket = first + scanThread();
        bool inside = bucket < GLINT_FRAME.bucketCount;
        uint count = inside ? GLINT_FRAME.bucketCounts.data[bucket] : 0u;
        uint total;
        uint begin = slots + scanWorkgroup(roomOf(count), total);
        if (inside) {
            storeBucket(bucket, begin, count);
            clearGap(begin, count);
        }
        slots += total;
    }
    if (scanThread() == 0u) {
        storeSlotCount(slots);
    }
}
