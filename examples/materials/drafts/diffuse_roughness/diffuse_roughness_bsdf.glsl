// Reads the roughness of the diffuse lobe.
#include "hit/surface_values.glsl"

void diffuseRoughnessBsdf(Hit hit, Features features, inout SurfaceValues values, inout Surface surface) {
    float roughness = GLINT_MATERIAL_DIFFUSE_ROUGHNESS_FACTOR(hit);
    if (GLINT_HAS_DIFFUSE_ROUGHNESS_TEXTURE(features)) {
        roughness *= sampleSlot(hit, kDiffuseRoughnessTexture, features).a;
    }
    surface.bsdf.layers.diffuseRoughness.roughness = roughness;
}
