// Reads the parameters of the fuzz.
#include "hit/surface_values.glsl"

void fuzzBsdf(Hit hit, Features features, inout SurfaceValues values, inout Surface surface) {
    float factor = GLINT_MATERIAL_FUZZ_FACTOR(hit);
    if (GLINT_HAS_FUZZ_TEXTURE(features)) {
        factor *= sampleSlot(hit, kFuzzTexture, features).r;
    }
    vec3 color = GLINT_MATERIAL_FUZZ_COLOR_FACTOR(hit);
    if (GLINT_HAS_FUZZ_COLOR_TEXTURE(features)) {
        color *= sampleSlot(hit, kFuzzColorTexture, features).rgb;
    }
    float roughness = GLINT_MATERIAL_FUZZ_ROUGHNESS_FACTOR(hit);
    if (GLINT_HAS_FUZZ_ROUGHNESS_TEXTURE(features)) {
        roughness *= sampleSlot(hit, kFuzzRoughnessTexture, features).a;
    }
    surface.bsdf.layers.fuzz.color = color;
    surface.bsdf.layers.fuzz.factor = factor;
    surface.bsdf.layers.fuzz.roughness = max(roughness, kMinFuzzRoughness);
}
