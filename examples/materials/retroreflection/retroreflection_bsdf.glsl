// Reads the parameters of the retroreflection.
#include "hit/surface_values.glsl"

void retroreflectionBsdf(Hit hit, Features features, inout SurfaceValues values, inout Surface surface) {
    float factor = GLINT_MATERIAL_RETROREFLECTION_FACTOR(hit);
    if (GLINT_HAS_RETROREFLECTION_TEXTURE(features)) {
        factor *= sampleSlot(hit, kRetroreflectionTexture, features).r;
    }
    float roughness = GLINT_MATERIAL_RETROREFLECTION_ROUGHNESS(hit);
    surface.bsdf.layers.retroreflection = Retroreflection(GLINT_MATERIAL_RETROREFLECTION_COLOR(hit), factor,
                                                          max(roughness * roughness, kMinAlpha));
}
