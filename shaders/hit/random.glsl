// Counter-based random numbers: the PCG output permutation (O'Neill 2014) as a hash, after Jarzynski and Olano, "Hash
// Functions for GPU Rendering" (2020).

uint pcgHash(uint value) {
    uint state = value * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

uint hashOf(uint a, uint b, uint c) {
    return pcgHash(a + pcgHash(b + pcgHash(c)));
}

// Turns 24 bits into a number in [0, 1).
float unitOf(uint bits) {
    return float(bits >> 8) * (1.0 / 16777216.0);
}

// Returns a number that is uniform in [0, 1). For a pixel, sample, seed and dimension it is the same with every
// strategy.
float randomUnit(uint pixel, uint sampleIndex, uint seed, uint dimension) {
    return unitOf(pcgHash(pixel + hashOf(sampleIndex, dimension, seed)));
}
