// Filtered samples of textures. A TextureRecord names the texture and its sampler. Here these are indices into the
// arrays of Glint's scene.
#include "host/resources.glsl"
// The raster pass reads alpha alone, and fragment shaders may lack atomics.
#if GLINT_TEXTURE_LEVELS && !defined(GLINT_RASTER)
#include "host/texture_levels.glsl"
#define GLINT_NOTE_LEVEL(record, level) noteTextureLevel(record, level)
#else
#define GLINT_NOTE_LEVEL(record, level)
#endif

#define GLINT_SAMPLER(record)                                      \
    sampler2D(sceneTextures[nonuniformEXT((record).textureIndex)], \
              sceneSamplers[nonuniformEXT((record).samplerIndex)])

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

#ifdef GLINT_RASTER
// In fragment shaders: the level that the derivatives of the screen choose, plus `bias`. The record is the same for the
// whole draw.
vec4 hostScreenTexture(TextureRecord record, vec2 uv, float bias) {
    return texture(sampler2D(sceneTextures[record.textureIndex], sceneSamplers[record.samplerIndex]), uv, bias);
}
#endif
