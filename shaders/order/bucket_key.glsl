// Keys hold the bucket of each hit in as few bytes as possible, so that the ordering reads little memory.
#include "generated/most_buckets.glsl"
#include "hit/bindings.glsl"

// At least the number of buckets.
const uint kBuckets = GLINT_MOST_BUCKETS;

#if GLINT_MOST_BUCKETS <= 256
const uint kKeyBytes = 1u;
#elif GLINT_MOST_BUCKETS <= 65536
const uint kKeyBytes = 2u;
#else
const uint kKeyBytes = 4u;
#endif
const uint kKeyBits = 8u * kKeyBytes;
const uint kKeysOfWord = 4u / kKeyBytes;
const uint kKeysOfVector = 16u / kKeyBytes;

// Memory is accessed by words alone: not every device can store a byte.
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer KeyWordArray { uint data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer KeyPairArray { uvec2 data[]; };

// Returns key `index` of those in a word.
uint keyOfWord(uint word, uint index) {
    return bitfieldExtract(word, int(index * kKeyBits), int(kKeyBits));
}

// Returns the key of the hit `index`.
uint storedKey(uint index) {
    return keyOfWord(KeyWordArray(GLINT_FRAME.bucketKeys).data[index / kKeysOfWord], index % kKeysOfWord);
}

// Returns key `index` of those in a vector.
uint keyOf(uvec4 keys, uint index) {
    return keyOfWord(keys[index / kKeysOfWord], index % kKeysOfWord);
}
