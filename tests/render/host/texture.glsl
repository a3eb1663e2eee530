// A texture function of the tests: the footprint of opposite gradients is the same.
#include "host/resources.glsl"

vec4 hostTexture(TextureRecord record, vec2 uv, vec4 gradients) {
    return textureGrad(sampler2D(sceneTextures[nonuniformEXT(record.textureIndex)],
                                 sceneSamplers[nonuniformEXT(record.samplerIndex)]),
                       uv, -gradients.xy, -gradients.zw);
}

vec4 hostFinestTexture(TextureRecord record, vec2 uv) {
    return textureLod(sampler2D(sceneTextures[nonuniformEXT(record.textureIndex)],
                                sceneSamplers[nonuniformEXT(record.samplerIndex)]),
                      uv, 0.0);
}

vec3 hostTextureFilter(TextureRecord record) {
    return vec3(textureSize(sampler2D(sceneTextures[nonuniformEXT(record.textureIndex)],
                                      sceneSamplers[nonuniformEXT(record.samplerIndex)]),
                            0),
                record.anisotropy);
}

#ifdef GLINT_RASTER
vec4 hostScreenTexture(TextureRecord record, vec2 uv, float bias) {
    return texture(sampler2D(sceneTextures[record.textureIndex], sceneSamplers[record.samplerIndex]), uv, bias);
}
#endif
