#version 460
// G-buffer: stores which triangle each pixel sees. The lighting pass reads materials, once for each pixel.
#include "hit/bindings.glsl"
#include "bsdf/features.glsl"

layout(location = 0) flat in uint primitive;
layout(location = 3) flat in uint geometryIndex;
#if GLINT_HAS_MASKED
layout(location = 1) in vec2 texCoord;
layout(location = 2) in float vertexAlpha;
#endif

layout(location = 0) out uvec2 surface;

void main() {
#if GLINT_HAS_MASKED
    GeometryRecord geometry = GLINT_FRAME.geometries.data[geometryIndex];
    if ((geometry.flags & kGeometryMasked) != 0u) {
        MaterialRecord material = GLINT_FRAME.materials.data[geometry.materialIndex];
        float alpha = material.baseColorFactor.a * vertexAlpha;
        if ((geometry.featureInputs & GLINT_BASE_COLOR_TEXTURE) != 0u) {
            TextureRecord record = GLINT_TEXTURE(material, kBaseColorTexture);
            // All instances of a draw have one material: the indices are uniform.
#if GLINT_TEXTURE_LOD_CONES
            alpha *= texture(sampler2D(sceneTextures[record.textureIndex], sceneSamplers[record.samplerIndex]),
                             texCoord, GLINT_FRAME.sampleLodBias)
                         .a;
#else
            alpha *= textureLod(sampler2D(sceneTextures[record.textureIndex], sceneSamplers[record.samplerIndex]),
                                texCoord, 0.0)
                         .a;
#endif
        }
        if (alpha < material.alphaCutoff) {
            discard;
        }
    }
#endif
    surface = uvec2(geometryIndex, primitive);
}
