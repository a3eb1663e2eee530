// Counter-based random numbers: PCG output permutation (O'Neill 2014) as a hash, after Jarzynski and Olano, "Hash
// Functions for GPU Rendering" (2020).

uint pcgHash(uint value) {
    uint state = value * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

// Uniform in [0, 1), 24 bits. The same for a pixel, sample, seed and dimension whatever the strategy.
float randomUnit(uint pixel, uint sampleIndex, uint seed, uint dimension) {
    uint bits = pcgHash(pixel + pcgHash(sampleIndex + pcgHash(dimension + pcgHash(seed))));
    return float(bits >> 8) * (1.0 / 16777216.0);
}
