// Filtered samples of textures. A TextureRecord names the texture and its sampler. Here these are indices into the
// arrays of Glint's scene.
#include "host/resources.glsl"

// Packages with --texture-levels note the finest level that is read of each texture. The raster pass reads alpha alone,
// and fragment shaders may lack atomics.
#if GLINT_TEXTURE_LEVELS && !defined(GLINT_RASTER)
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

#define GLINT_NOTE_LEVEL(record, level) noteTextureLevel(record, level)
#else
#define GLINT_NOTE_LEVEL(record, level)
#endif

#define GLINT_SAMPLER_OF(type, textures, record)              \
    type(textures[nonuniformEXT((record).textureIndex)], \
         sceneSamplers[nonuniformEXT((record).samplerIndex)])
#define GLINT_SAMPLER(record) GLINT_SAMPLER_OF(sampler2D, sceneTextures, record)

// `gradients` are (du, dv) along one axis of the footprint, then along the other. They are 0 for the finest level.
vec4 hostTexture(TextureRecord record, vec2 uv, vec4 gradients) {
    GLINT_NOTE_LEVEL(record, gradientLevel(record, gradients));
    return textureGrad(GLINT_SAMPLER(record), uv, gradients.xy, gradients.zw);
}

// The finest level.
vec4 hostFinestTexture(TextureRecord record, vec2 uv) {
    GLINT_NOTE_LEVEL(record, 0.0);
    return textureLod(GLINT_SAMPLER(record), uv, 0.0);
}

// Returns the size of the finest level in texels, and the most anisotropy that the sampler covers (1 for none).
vec3 hostTextureFilter(TextureRecord record) {
    return vec3(record.texels, record.anisotropy);
}

// Textures of other dimensions, which packs declare.
#if GLINT_ARRAY_TEXTURES
// Layers are rounded to the nearest that there is.
vec4 hostArrayTexture(TextureRecord record, vec3 uvAndLayer, vec4 gradients) {
    GLINT_NOTE_LEVEL(record, gradientLevel(record, gradients));
    return textureGrad(GLINT_SAMPLER_OF(sampler2DArray, sceneArrays, record), uvAndLayer, gradients.xy, gradients.zw);
}

vec4 hostArrayTextureLevel(TextureRecord record, vec3 uvAndLayer, float level) {
    GLINT_NOTE_LEVEL(record, level);
    return textureLod(GLINT_SAMPLER_OF(sampler2DArray, sceneArrays, record), uvAndLayer, level);
}
#endif
#if GLINT_CUBE_TEXTURES
vec4 hostCubeTexture(TextureRecord record, vec3 direction, float level) {
    GLINT_NOTE_LEVEL(record, level);
    return textureLod(GLINT_SAMPLER_OF(samplerCube, sceneCubes, record), direction, level);
}
#endif
#if GLINT_VOLUME_TEXTURES
vec4 hostVolumeTexture(TextureRecord record, vec3 place, float level) {
    GLINT_NOTE_LEVEL(record, level);
    return textureLod(GLINT_SAMPLER_OF(sampler3D, sceneVolumes, record), place, level);
}
#endif

#ifdef GLINT_RASTER
// For fragment shaders: uses the level that the derivatives of the screen choose, plus `bias`. The record is the same
// for the whole draw.
vec4 hostScreenTexture(TextureRecord record, vec2 uv, float bias) {
    return texture(sampler2D(sceneTextures[record.textureIndex], sceneSamplers[record.samplerIndex]), uv, bias);
}
#endif
