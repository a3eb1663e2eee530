// Stochastic transparency (Enderton, Sintorn, Shirley and Luebke 2010): a ray or pixel that meets a surface of
// alphaMode BLEND stops there with the probability alpha, and otherwise does not see it. The mean over samples is the
// result of the operator "over" for surfaces in the order of depth (glTF 2.0, section 3.9.4), so nothing needs sorting.
#include "host/random.glsl"

#if GLINT_BLENDED

// The pair of the sequence. It is not one of the effects' or the lights'.
const uint kPairBlend = 15u;

// Returns a number in [0, 1) that alpha is compared with. It is independent for each triangle that the ray or pixel
// `key` meets, and over the samples of a pixel it is well distributed.
float blendThreshold(uint key, uint geometryIndex, uint primitive) {
    return hostRandomPair(hashOf(key, geometryIndex, primitive), kPairBlend).x;
}

#endif
