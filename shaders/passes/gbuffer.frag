#version 460
// G-buffer: stores which triangle each pixel sees. The passes of first hits read materials, once for each
// pixel.
#define GLINT_RASTER
#include "bsdf/features.glsl"
#include "hit/blend.glsl"
#include "host/geometry.glsl"
#include "host/material.glsl"
#include "host/texture.glsl"
#if GLINT_MASK_STAGES
#include "generated/mask_stages.glsl"
#endif

layout(location = 0) flat in uint primitive;
layout(location = 3) flat in uint geometryIndex;
#if GLINT_MASK_STAGES
layout(location = 1) in vec2 barycentrics;
#elif GLINT_MAY_MASK
layout(location = 1) in vec2 texCoord;
layout(location = 2) in float vertexAlpha;
#endif

layout(location = 0) out uvec2 surface;

#if GLINT_MAY_MASK
// Returns the alpha of the base colour texture. All instances of a draw have one material: the indices are uniform.
float textureAlpha(MaterialRecord material, vec2 uv) {
    TextureRecord record = GLINT_TEXTURE(material, GLINT_ROLE_BASE_COLOR_SLOT);
#if GLINT_TEXTURE_LOD_CONES
    return hostScreenTexture(record, uv, GLINT_FRAME.sampleLodBias).a;
#else
    return hostFinestTexture(record, uv).a;
#endif
}
#endif

void main() {
#if GLINT_MAY_MASK
    HostGeometry geometry = hostGeometry(geometryIndex);
    if ((geometry.flags & kGeometryMasked) != 0u) {
        MaterialRecord material = hostMaterials().data[geometry.materialIndex];
        float alpha = GLINT_BASE_ALPHA(material, geometry.featureModel);
        vec2 uv = vec2(0.0);
#if GLINT_MASK_STAGES
        Features features = GLINT_PRIMARY_FEATURES(geometry);
        SurfacePoint point = surfacePoint(geometry, primitive, barycentrics, features);
        runMaskCoordinates(point, features);
        if (inputOfKey(features, GLINT_ROLE_BASE_COLOR_TEXTURE)) {
            uv = pointCoordinates(point, GLINT_ROLE_BASE_COLOR_SLOT, features);
        }
        if (inputOfKey(features, GLINT_ROLE_VERTEX_COLOR)) {
            alpha *= vertexAlpha(geometry, primitive, barycentrics);
        }
#else
        uv = texCoord;
        alpha *= vertexAlpha;
#endif
        if ((geometry.featureInputs & GLINT_ROLE_BASE_COLOR_TEXTURE) != 0u) {
            alpha *= textureAlpha(material, uv);
        }
#if GLINT_MASK_STAGES
        runMaskOpacity(point, features, alpha);
#endif
#if GLINT_BLENDED
        if ((geometry.flags & kGeometryBlended) != 0u) {
            uvec2 pixel = uvec2(gl_FragCoord.xy);
            if (alpha <= blendThreshold(pixel.x + pixel.y * GLINT_FRAME.width, geometryIndex, primitive)) {
                discard;
            }
        } else
#endif
        if (alpha < GLINT_ROLE_ALPHA_CUTOFF(material)) {
            discard;
        }
    }
#endif
    surface = uvec2(geometryIndex, primitive);
}
