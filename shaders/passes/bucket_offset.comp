#version 460
// Ordering, second pass: where each bucket begins. One workgroup, kScanGroupSize buckets at a time. The ordering
// tile-sort has no such pass: the last workgroup of its first one does the same.
#define GLINT_SCAN_GROUP_SIZE kScanGroupSize
#include "hit/bucket_scan.glsl"

layout(local_size_x = kScanGroupSize) in;

void main() {
    scanBuckets();
}
