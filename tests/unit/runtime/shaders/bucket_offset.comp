#version 460
#extension GL_GOOGLE_include_directive : require
#include "common.glsl"
#include "list.glsl"

layout(local_size_x = 1) in;

void main() {
    uint begin = 0u;
    for (uint bucket = 0u; bucket < FRAME.bucketCount; ++bucket) {
        uint count = FRAME.bucketCounts.data[bucket];
        FRAME.bucketBegins.data[bucket] = begin;
        FRAME.bucketCursors.data[bucket] = begin;
        FRAME.bucketDispatch.data[bucket] = listDispatch(count);
        begin += count;
    }
}
