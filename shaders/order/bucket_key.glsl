// Keys hold the bucket of each hit in as few bytes as possible, so that the ordering reads little memory.
#include "hit/bindings.glsl"

const uint kBuckets = GLINT_CASE_COUNT + 1u;

#if GLINT_CASE_COUNT < 256
#extension GL_EXT_shader_8bit_storage : require
#define GLINT_KEY uint8_t
const uint kKeyBytes = 1u;
#elif GLINT_CASE_COUNT < 65536
#extension GL_EXT_shader_16bit_storage : require
#define GLINT_KEY uint16_t
const uint kKeyBytes = 2u;
#else
#define GLINT_KEY uint
const uint kKeyBytes = 4u;
#endif

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer KeyPieces { GLINT_KEY data[]; };

void storeKey(uint index, uint bucket) {
    KeyPieces(GLINT_FRAME.bucketKeys).data[index] = GLINT_KEY(bucket);
}

uint storedKey(uint index) {
    return uint(KeyPieces(GLINT_FRAME.bucketKeys).data[index]);
}

layout(buffer_reference, scalar, buffer_reference_align = 8) buffer KeyPairArray { uvec2 data[]; };

const uint kKeysOfWord = 4u / kKeyBytes;
const uint kKeysOfVector = 16u / kKeyBytes;

// Returns key `index` of those in a word.
uint keyOfWord(uint word, uint index) {
    const int bits = int(8u * kKeyBytes);
    return bitfieldExtract(word, int(index) * bits, bits);
}

// Returns key `index` of those in a vector.
uint keyOf(uvec4 keys, uint index) {
    return keyOfWord(keys[index / kKeysOfWord], index % kKeysOfWord);
}
