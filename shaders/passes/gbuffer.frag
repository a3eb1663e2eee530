#version 460
// G-buffer: stores which triangle each pixel sees. The lighting pass reads materials, once for each pixel.
#define GLINT_RASTER
#include "bsdf/features.glsl"
#include "host/geometry.glsl"
#include "host/material.glsl"
#include "host/texture.glsl"

layout(location = 0) flat in uint primitive;
layout(location = 3) flat in uint geometryIndex;
#if GLINT_HAS_MASKED
layout(location = 1) in vec2 texCoord;
layout(location = 2) in float vertexAlpha;
#endif

layout(location = 0) out uvec2 surface;

void main() {
#if GLINT_HAS_MASKED
    HostGeometry geometry = hostGeometry(geometryIndex);
    if ((geometry.flags & kGeometryMasked) != 0u) {
        MaterialRecord material = hostMaterials().data[geometry.materialIndex];
        float alpha = material.baseColorFactor.a * vertexAlpha;
        if ((geometry.featureInputs & GLINT_BASE_COLOR_TEXTURE) != 0u) {
            TextureRecord record = GLINT_TEXTURE(material, kBaseColorTexture);
#if GLINT_TEXTURE_LOD_CONES
            alpha *= hostScreenTexture(record, texCoord, GLINT_FRAME.sampleLodBias).a;
#else
            alpha *= hostFinestTexture(record, texCoord).a;
#endif
        }
        if (alpha < material.alphaCutoff) {
            discard;
        }
    }
#endif
    surface = uvec2(geometryIndex, primitive);
}
