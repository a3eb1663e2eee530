// Notes the finest level that is read of each texture, in packages with --texture-levels.
#include "host/resources.glsl"

// The level that a sampler chooses: Vulkan 1.3, "Scale Factor, Level-of-Detail and Image Level(s) Operations". It is
// relative to the size of the whole image, whichever levels are on the device.
float gradientLevel(TextureRecord record, vec4 gradients) {
    vec4 inTexels = gradients * vec4(record.texels, record.texels);
    float first = dot(inTexels.xy, inTexels.xy);
    float second = dot(inTexels.zw, inTexels.zw);
    float width = max(max(first, second) / (record.anisotropy * record.anisotropy), min(first, second));
    return width > 0.0 ? 0.5 * log2(width) : 0.0;
}

// Most reads find that the level is known already, so the atomic is rare.
void noteTextureLevel(TextureRecord record, float level) {
    uint counter = kCounterEffects + kCounterCopies * kCountsOfEffect * GLINT_EFFECT_COUNT + record.textureIndex;
    uint finest = kFinestTextureLevel - uint(clamp(level, 0.0, float(kFinestTextureLevel - 1u)));
    if (GLINT_FRAME.counters.data[counter] < finest) {
        atomicMax(GLINT_FRAME.counters.data[counter], finest);
    }
}
