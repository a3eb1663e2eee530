// KHR_materials_specular.
#include "hit/surface_values.glsl"

void scaleByColorTexture(Hit hit, Features features, inout vec3 specularColor) {
    if (hasInput(features, GLINT_SPECULAR_COLOR_TEXTURE)) {
        specularColor *= sampleSlot(hit, kSpecularColorTexture, features).rgb;
    }
}

void specularSurface(Hit hit, Features features, inout SurfaceValues values) {
    GLINT_RELAXED float specular = GLINT_MATERIAL_SPECULAR_FACTOR(hit);
    vec3 specularColor = GLINT_MATERIAL_SPECULAR_COLOR_FACTOR(hit);
    if (hasInput(features, GLINT_SPECULAR_TEXTURE)) {
        specular *= sampleSlot(hit, kSpecularTexture, features).a;
    }
    scaleByColorTexture(hit, features, specularColor);
    values.f0 = min(values.f0 * specularColor, vec3(1.0)) * specular;
    values.f90 = specular;
}
