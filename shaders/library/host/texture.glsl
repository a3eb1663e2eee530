#include "host/resources.glsl"

vec4 hostTexture(TextureRecord record, vec2 uv, vec4 gradients) {
    return glintHostTexture(record.textureIndex, record.samplerIndex, uv, gradients.xy, gradients.zw);
}

vec4 hostFinestTexture(TextureRecord record, vec2 uv) {
    return glintHostTexture(record.textureIndex, record.samplerIndex, uv, vec2(0.0), vec2(0.0));
}

#if GLINT_ARRAY_TEXTURES
vec4 hostArrayTexture(TextureRecord record, vec3 uvAndLayer, vec4 gradients) {
    return glintHostArrayTexture(record.textureIndex, record.samplerIndex, uvAndLayer, gradients.xy, gradients.zw);
}

vec4 hostArrayTextureLevel(TextureRecord record, vec3 uvAndLayer, float level) {
    return glintHostArrayTextureLevel(record.textureIndex, record.samplerIndex, uvAndLayer, level);
}
#endif
#if GLINT_CUBE_TEXTURES
vec4 hostCubeTexture(TextureRecord record, vec3 direction, float level) {
    return glintHostCubeTexture(record.textureIndex, record.samplerIndex, direction, level);
}
#endif
#if GLINT_VOLUME_TEXTURES
vec4 hostVolumeTexture(TextureRecord record, vec3 place, float level) {
    return glintHostVolumeTexture(record.textureIndex, record.samplerIndex, place, level);
}
#endif

vec3 hostTextureFilter(TextureRecord record) {
    return glintHostTextureFilter(record.textureIndex, record.samplerIndex);
}
