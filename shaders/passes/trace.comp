#version 460
// Traces the ray list into hit records, unless a host gives the hits, and stores the bucket of each hit.
#define GLINT_MODULE_ALWAYS_LOBES GLINT_HIT_ALWAYS_LOBES
#define GLINT_MODULE_ALWAYS_INPUTS GLINT_HIT_ALWAYS_INPUTS
#define GLINT_MODULE_ANY_LOBES (GLINT_HIT_ALWAYS_LOBES | GLINT_HIT_SOMETIMES_LOBES)
#define GLINT_MODULE_ANY_INPUTS (GLINT_HIT_ALWAYS_INPUTS | GLINT_HIT_SOMETIMES_INPUTS)
#define GLINT_MODULE_MODEL GLINT_HIT_MODEL
#include "order/bucket_key.glsl"
#include "order/bucket.glsl"
#include "order/found.glsl"

GLINT_RAY_WORKGROUP

// Neighbours store the other keys of the word. Collecting them in shared memory, which many drivers need for the stacks
// of their traversal, would cost more than two atomics that return nothing.
void storeKey(uint index, uint key) {
    KeyWordArray words = KeyWordArray(GLINT_FRAME.bucketKeys);
    uint shift = index % kKeysOfWord * kKeyBits;
    atomicAnd(words.data[index / kKeysOfWord], ~(0xFFFFFFFFu >> (32u - kKeyBits) << shift));
    atomicOr(words.data[index / kKeysOfWord], key << shift);
}

void main() {
    uint index = listIndex();
    if (index < GLINT_FRAME.rayDispatch.data[0].elementCount) {
        RayRecord ray = listedRay(index);
        GLINT_CLOCK_START
        HitRecord hit = hitOfRay(index, ray);
        storeHit(index, hit);
        storeKey(index, bucketOfGeometry(hit.geometry));
        GLINT_CLOCK_STOP
    }
}
