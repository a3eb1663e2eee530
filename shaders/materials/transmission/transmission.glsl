// KHR_materials_transmission: the light that passes the microfacets is taken from the diffuse lobe.
#include "hit/surface_values.glsl"

void transmissionBsdf(Hit hit, Features features, inout SurfaceValues values, inout Surface surface) {
    GLINT_RELAXED float transmission = GLINT_MATERIAL_TRANSMISSION_FACTOR(hit);
    if (hasInput(features, GLINT_TRANSMISSION_TEXTURE)) {
        transmission *= sampleSlot(hit, kTransmissionTexture, features).r;
    }
    surface.bsdf.base.transmitted = values.color.rgb * values.dielectric * transmission;
    surface.bsdf.diffuse *= 1.0 - transmission;
    values.dielectric *= 1.0 - transmission;
}
