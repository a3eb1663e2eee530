// KHR_materials_volume: the index on the far side, and the absorption of the volume.
#include "hit/surface_values.glsl"
#include "materials/volume/nesting.glsl"

void volumeBsdf(Hit hit, Features features, inout SurfaceValues values, inout Surface surface) {
    bool inside = showsBack(features) && !hit.frontFace;
#if GLINT_PATHS
    nestMedia(hit, features, hit.arrival.media, surface.bsdf.base);
#else
    vec3 iors = mediumIors(hit, features);
    surface.bsdf.base.eta = inside ? vec3(1.0) / iors : iors;
#endif
    if (inside) {
        // From within, more light is reflected than by the outside's albedos, so the diffuse lobe is removed.
        surface.bsdf.diffuse = vec3(0.0);
        surface.bsdf.diffuseTransmitted = vec3(0.0);
    }
#if GLINT_PATHS
    // The path goes on in the volume, which absorbs over the real distance.
    bool followed = pathGoesOn();
#else
    const bool followed = false;
#endif
    if (hasLobe(features, GLINT_ATTENUATION) && !followed) {
        float thickness = GLINT_MATERIAL_THICKNESS_FACTOR(hit) * hit.scale;
        if (hasInput(features, GLINT_THICKNESS_TEXTURE)) {
            vec4 texel = sampleSlot(hit, kThicknessTexture, features);
            thickness *= texel.g;
        }
        GLINT_RELAXED vec3 transmittance = volumeTransmittance(GLINT_MATERIAL_ABSORPTION(hit), thickness);
#if GLINT_SHADOW_GLASS
        surface.unabsorbed = transmittance;
#else
        surface.bsdf.base.transmitted *= transmittance;
        surface.bsdf.diffuseTransmitted *= transmittance;
#endif
    }
}
