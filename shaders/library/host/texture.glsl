#include "host/resources.glsl"

vec4 hostTexture(TextureRecord record, vec2 uv, vec4 gradients) {
    return glintHostTexture(record.textureIndex, record.samplerIndex, uv, gradients.xy, gradients.zw);
}

vec4 hostFinestTexture(TextureRecord record, vec2 uv) {
    return glintHostTexture(record.textureIndex, record.samplerIndex, uv, vec2(0.0), vec2(0.0));
}

vec3 hostTextureFilter(TextureRecord record) {
    return glintHostTextureFilter(record.textureIndex, record.samplerIndex);
}
