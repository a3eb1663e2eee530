#version 460
#extension GL_GOOGLE_include_directive : require
#include "common.glsl"
#include "images.glsl"
#include "first_list.glsl"

layout(local_size_x = kFirstGroupSize) in;

void main() {
    for (uint k = 0u; k < kFirstPixelsOfThread; ++k) {
        uint element = firstElement(k);
        if (element < FRAME.width * FRAME.height) {
            uint slot = atomicAdd(FRAME.bucketCursors.data[bucketOfPixel(element)], 1u);
            FRAME.orderedHits.data[slot] = element;
        }
    }
}
