// A low-discrepancy sequence for each pixel: Sobol' points with Owen's scrambling, by hashes (Burley, "Practical
// Hash-based Owen Scrambling", JCGT 2020). Any power of two of successive samples is stratified, and pixels and pairs
// of dimensions are independent of each other.
#include "hit/random.glsl"

// Permutes each bit depending on those below it: Laine and Karras (2011), with the constants of Vegdahl (2021).
uint scrambleUpwards(uint x, uint seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

// Owen's scrambling: permutes each bit depending on those above it.
uint scrambleDownwards(uint x, uint seed) {
    return bitfieldReverse(scrambleUpwards(bitfieldReverse(x), seed));
}

// The second coordinate of Sobol's sequence; the first is the index with its bits reversed.
uint sobolSecond(uint index) {
    uint result = 0u;
    uint direction = 0x80000000u;
    for (uint rest = index; rest != 0u; rest >>= 1) {
        result ^= (rest & 1u) != 0u ? direction : 0u;
        direction ^= direction >> 1;
    }
    return result;
}

// Returns two dimensions of a pixel's sample, in [0, 1). Pairs are shuffled relative to each other.
vec2 sequencePair(uint pixel, uint sampleIndex, uint seed, uint pair) {
    uint hash = hashOf(pixel, seed, pair);
    uint index = scrambleDownwards(sampleIndex, hash);
    uint first = scrambleDownwards(bitfieldReverse(index), hashOf(hash, 1u, 0u));
    uint second = scrambleDownwards(sobolSecond(index), hashOf(hash, 2u, 0u));
    return vec2(unitOf(first), unitOf(second));
}
