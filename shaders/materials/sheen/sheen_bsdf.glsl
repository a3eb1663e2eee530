// Reads the parameters of the sheen.
#include "hit/surface_values.glsl"

void sheenBsdf(Hit hit, Features features, inout SurfaceValues values, inout Surface surface) {
    float roughness = GLINT_MATERIAL_SHEEN_ROUGHNESS_FACTOR(hit);
    GLINT_RELAXED vec3 color = GLINT_MATERIAL_SHEEN_COLOR_FACTOR(hit);
    if (hasInput(features, GLINT_SHEEN_COLOR_TEXTURE)) {
        color *= sampleSlot(hit, kSheenColorTexture, features).rgb;
    }
    if (hasInput(features, GLINT_SHEEN_ROUGHNESS_TEXTURE)) {
        vec4 texel = sampleSlot(hit, kSheenRoughnessTexture, features);
        roughness *= texel.a;
    }
    surface.bsdf.layers.sheen.color = color;
    surface.bsdf.layers.sheen.alpha = max(roughness * roughness, kMinSheenAlpha);
}
