#version 460
#extension GL_GOOGLE_include_directive : require
// The radiance is geometry + 1, primitive, and the first texel of the material's base colour at mip 1.
#include "common.glsl"
#include "images.glsl"

layout(local_size_x = kPixelGroupSize, local_size_y = kPixelGroupSize) in;

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= FRAME.width || pixel.y >= FRAME.height) {
        return;
    }
    uvec2 surface = imageLoad(surfaceImage, ivec2(pixel)).xy;
    vec4 radiance = vec4(0.0);
    if (surface.x != kNoSurface) {
        GeometryRecord geometry = FRAME.geometries.data[surface.x];
        TextureRecord record = FRAME.materials.data[geometry.materialIndex].textures[kBaseColorTexture];
        vec4 texel = textureLod(sampler2D(sceneTextures[nonuniformEXT(record.textureIndex)],
                                          sceneSamplers[nonuniformEXT(record.samplerIndex)]),
                                vec2(0.5), 1.0);
        radiance = vec4(float(surface.x) + 1.0, float(surface.y), texel.r, 1.0);
    }
    imageStore(radianceImage, ivec2(pixel), radiance);
    // Where no ray is sent, no light is found.
    FRAME.sampleStarts.data[pixel.x + pixel.y * FRAME.width] = SampleStart(vec3(0.0), 0u);
}
