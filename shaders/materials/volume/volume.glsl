// KHR_materials_volume: the index on the far side, and what the volume absorbs.
#include "hit/surface_values.glsl"
#include "materials/dispersion/dispersion.glsl"
#include "materials/ior/ior.glsl"
#include "materials/volume/attenuation.glsl"

// The indices of the surface's own medium for red, green and blue light.
vec3 mediumIors(Hit hit, Features features) {
    float ior = mediumIor(hit, features);
    if (hasLobe(features, GLINT_DISPERSION)) {
        return dispersedIor(ior, GLINT_MATERIAL_DISPERSION(hit));
    }
    return vec3(ior);
}

void volumeBsdf(Hit hit, Features features, inout SurfaceValues values, inout Surface surface) {
    vec3 iors = mediumIors(hit, features);
    bool inside = showsBack(features) && !hit.frontFace;
    surface.bsdf.eta = inside ? vec3(1.0) / iors : iors;
    if (inside) {
        // From within, more is reflected than the albedos of the outside say, so the diffuse lobe is removed.
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
        surface.bsdf.transmitted *= transmittance;
        surface.bsdf.diffuseTransmitted *= transmittance;
#endif
    }
}
