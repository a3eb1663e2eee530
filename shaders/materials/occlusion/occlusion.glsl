// The occlusion texture.
#include "hit/surface_values.glsl"

void occlusionSurface(Hit hit, Features features, inout SurfaceValues values) {
    if (hasInput(features, GLINT_OCCLUSION_TEXTURE)) {
        GLINT_RELAXED float texel = sampleSlot(hit, kOcclusionTexture, features).r;
        values.occlusion = 1.0 + GLINT_MATERIAL_OCCLUSION_STRENGTH(hit) * (texel - 1.0);
    }
}
