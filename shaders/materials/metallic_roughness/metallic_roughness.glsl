// Metallic-roughness: glTF 2.0, section 3.9.2.
#include "hit/surface_values.glsl"

GLINT_RELAXED vec4 texturedBaseColor(Hit hit, Features features) {
    GLINT_RELAXED vec4 color = GLINT_MATERIAL_BASE_COLOR_FACTOR(hit);
    if (hasInput(features, GLINT_BASE_COLOR_TEXTURE)) {
        color *= sampleSlot(hit, kBaseColorTexture, features);
    }
    return color;
}

void metallicRoughnessSurface(Hit hit, Features features, inout SurfaceValues values) {
    values.color = texturedBaseColor(hit, features);
    values.metallic = GLINT_MATERIAL_METALLIC_FACTOR(hit);
    values.roughness = GLINT_MATERIAL_ROUGHNESS_FACTOR(hit);
    if (hasInput(features, GLINT_METALLIC_ROUGHNESS_TEXTURE)) {
        vec4 texel = sampleSlot(hit, kMetallicRoughnessTexture, features);
        values.roughness *= texel.g;
        GLINT_RELAXED float metallic = texel.b;
        values.metallic *= metallic;
    }
}
