// KHR_materials_pbrSpecularGlossiness: diffuse and specular colours. Surfaces reflect at most all of the light.
#include "hit/surface_values.glsl"
#include "materials/metallic_roughness/metallic_roughness.glsl"

void specularGlossinessSurface(Hit hit, Features features, inout SurfaceValues values) {
    values.color = texturedBaseColor(hit, features);
    values.metallic = 0.0;
    values.f0 = GLINT_MATERIAL_GLOSSY_SPECULAR_FACTOR(hit);
    float glossiness = GLINT_MATERIAL_GLOSSINESS_FACTOR(hit);
    if (hasInput(features, GLINT_METALLIC_ROUGHNESS_TEXTURE)) {
        vec4 texel = sampleSlot(hit, kMetallicRoughnessTexture, features);
        GLINT_RELAXED vec3 tint = texel.rgb;
        values.f0 *= tint;
        glossiness *= texel.a;
    }
    values.roughness = 1.0 - glossiness;
}

void specularGlossinessBsdf(Hit hit, Features features, inout SurfaceValues values, inout Surface surface) {
    surface.bsdf.diffuse *= 1.0 - largest(values.f0);
}
