// Reads the parameters of the fuzz.
#include "hit/surface_values.glsl"

void fuzzBsdf(Hit hit, Features features, inout SurfaceValues values, inout Surface surface) {
    float factor = GLINT_MATERIAL_FUZZ_FACTOR(hit);
    if (GLINT_HAS_FUZZ_TEXTURE(features)) {
        factor *= sampleSlot(hit, kFuzzTexture, features).r;
    }
    surface.bsdf.layers.fuzz.color = GLINT_MATERIAL_FUZZ_COLOR_FACTOR(hit);
    surface.bsdf.layers.fuzz.factor = factor;
    surface.bsdf.layers.fuzz.roughness = max(GLINT_MATERIAL_FUZZ_ROUGHNESS_FACTOR(hit), kMinFuzzRoughness);
}
