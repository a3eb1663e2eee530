#version 460
// Finds the bucket of each pixel of a band, by the surface that it sees, and counts the pixels of each. Pixels without a
// surface, and those beyond the picture in its last tiles, are in bucket 0.
#define GLINT_FIRST_COUNTERS GLINT_FRAME.bucketCounts
#include "first/first_order.glsl"
#include "hit/images.glsl"
#include "order/bucket.glsl"

shared uint blockKeys[kBlock];

uint bucketOfElement(uint element, uint elements) {
    if (element >= elements) {
        return kNoGroup;
    }
    uvec2 pixel = listedPixel(element);
    return bucketOfGeometry(isInPicture(pixel) ? imageLoad(surfaceImage, ivec2(pixel)).x : kNoSurface);
}

// Neighbours have the other keys of a word, so words are put together in shared memory.
void storeKeys() {
    KeyWordArray words = KeyWordArray(GLINT_FRAME.bucketKeys);
    uint first = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * (kBlock / kKeysOfWord);
    for (uint i = gl_LocalInvocationIndex; i < kBlock / kKeysOfWord; i += kFirstGroupSize) {
        uint word = 0u;
        for (uint k = 0u; k < kKeysOfWord; ++k) {
            word |= (blockKeys[i * kKeysOfWord + k] & (0xFFFFFFFFu >> (32u - kKeyBits))) << (k * kKeyBits);
        }
        words.data[first + i] = word;
    }
}

void main() {
    uint elements = firstElements();
    uint buckets[kFirstPixelsOfThread];
    for (uint k = 0u; k < kFirstPixelsOfThread; ++k) {
        buckets[k] = bucketOfElement(firstElement(k), elements);
        blockKeys[k * kFirstGroupSize + gl_LocalInvocationIndex] = buckets[k];
    }
#if GLINT_FIRST_LOCAL
    clearBlock();
#else
    barrier();
#endif
    for (uint k = 0u; k < kFirstPixelsOfThread; ++k) {
        numberInGroup(buckets[k]);
    }
    storeKeys();
#if GLINT_FIRST_LOCAL
    barrier();
    for (uint bucket = gl_LocalInvocationIndex; bucket < kBuckets; bucket += kFirstGroupSize) {
        if (blockCounts[bucket] > 0u) {
            atomicAdd(GLINT_FIRST_COUNTERS.data[bucket], blockCounts[bucket]);
        }
    }
#endif
}
