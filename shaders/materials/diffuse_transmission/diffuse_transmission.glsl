// KHR_materials_diffuse_transmission: light that the diffuse lobe sends to the far side.
#include "hit/surface_values.glsl"

void diffuseTransmissionBsdf(Hit hit, Features features, inout SurfaceValues values, inout Surface surface) {
    GLINT_RELAXED float share = GLINT_MATERIAL_DIFFUSE_TRANSMISSION_FACTOR(hit);
    GLINT_RELAXED vec3 color = GLINT_MATERIAL_DIFFUSE_TRANSMISSION_COLOR_FACTOR(hit);
    if (hasInput(features, GLINT_DIFFUSE_TRANSMISSION_TEXTURE)) {
        share *= sampleSlot(hit, kDiffuseTransmissionTexture, features).a;
    }
    if (hasInput(features, GLINT_DIFFUSE_TRANSMISSION_COLOR_TEXTURE)) {
        color *= sampleSlot(hit, kDiffuseTransmissionColorTexture, features).rgb;
    }
    surface.bsdf.diffuseTransmitted = color * (share * values.dielectric);
    surface.bsdf.diffuse *= 1.0 - share;
    values.dielectric *= 1.0 - share;
}
