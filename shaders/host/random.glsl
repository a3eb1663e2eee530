// Random numbers in [0, 1). For the same arguments they are the same, whichever strategy shades the hit. `target` is
// the number of the hit's sample; for primary surfaces, of the pixel.
#include "host/resources.glsl"
#include "hit/random.glsl"
#include "hit/sequence.glsl"

float hostRandom(uint target, uint dimension) {
    return randomUnit(target, GLINT_FRAME.sampleIndex, GLINT_FRAME.seed, dimension);
}

// Two numbers that are well distributed over the samples of a pixel.
vec2 hostRandomPair(uint target, uint pair) {
    return sequencePair(target, GLINT_FRAME.sampleIndex, GLINT_FRAME.seed, pair);
}
