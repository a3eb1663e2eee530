// Counter-based random numbers: PCG output permutation (O'Neill 2014) as a hash, after Jarzynski and Olano, "Hash
// Functions for GPU Rendering" (2020).

uint pcgHash(uint value) {
    uint state = value * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

uint hashOf(uint a, uint b, uint c) {
    return pcgHash(a + pcgHash(b + pcgHash(c)));
}

// 24 bits as a number in [0, 1).
float unitOf(uint bits) {
    return float(bits >> 8) * (1.0 / 16777216.0);
}

// Uniform in [0, 1). The same for a pixel, sample, seed and dimension whatever the strategy.
float randomUnit(uint pixel, uint sampleIndex, uint seed, uint dimension) {
    return unitOf(pcgHash(pixel + hashOf(sampleIndex, dimension, seed)));
}
