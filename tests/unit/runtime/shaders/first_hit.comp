#version 460
#extension GL_GOOGLE_include_directive : require
// The radiance is geometry + 1, primitive, and the first texel of the material's base colour at mip 1.
#include "common.glsl"
#include "images.glsl"
#include "first_list.glsl"

layout(local_size_x = kRayGroupSize) in;

void main() {
    if (!hasPixel()) {
        return;
    }
    uvec2 pixel = shadedPixel();
    uvec2 surface = imageLoad(surfaceImage, ivec2(pixel)).xy;
    GeometryRecord geometry = FRAME.geometries.data[surface.x];
    TextureRecord record = FRAME.materials.data[geometry.materialIndex].textures[kBaseColorTexture];
    vec4 texel = textureLod(sampler2D(sceneTextures[nonuniformEXT(record.textureIndex)],
                                      sceneSamplers[nonuniformEXT(record.samplerIndex)]),
                            vec2(0.5), 1.0);
    storeFirst(pixel, vec4(float(surface.x) + 1.0, float(surface.y), texel.r, 1.0));
}
