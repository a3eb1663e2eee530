// The indices on both sides of the surface of a volume, which may lie within another one.
#include "materials/base/media.glsl"
#include "host/material.glsl"
#include "materials/dispersion/dispersion.glsl"
#include "materials/ior/ior.glsl"
#include "materials/specular/specular.glsl"

// The indices of the surface's own medium for red, green and blue light.
vec3 mediumIors(Hit hit, Features features) {
    float ior = mediumIor(hit, features);
    if (hasLobe(features, GLINT_DISPERSION)) {
        return dispersedIor(ior, GLINT_MATERIAL_DISPERSION(hit));
    }
    return vec3(ior);
}

// Returns the same for the number of a medium; 1 for none.
vec3 iorsOfMedium(uint number) {
    if (number == 0u) {
        return vec3(1.0);
    }
#ifdef GLINT_RECORD_IOR
    float ior = GLINT_RECORD_IOR(hostMaterials().data[number - 1u]);
#else
    float ior = kDefaultIor;
#endif
#ifdef GLINT_RECORD_DISPERSION
    return dispersedIor(ior, GLINT_RECORD_DISPERSION(hostMaterials().data[number - 1u]));
#else
    return vec3(ior);
#endif
}

// Sets the indices on both sides of a volume's surface, for the media that the ray is in.
void nestMedia(Hit hit, Features features, Media media, inout Base b) {
    // The medium outside of the surface.
    bool leavesInnermost = !hit.frontFace && placeOf(media, hit.material) == 0u;
    uint around = mediumAt(media, leavesInnermost ? 1u : 0u);
    vec3 outside = iorsOfMedium(around);
    vec3 own = mediumIors(hit, features);
    b.eta = hit.frontFace ? own / outside : outside / own;
    if (around != 0u) {
        // KHR_materials_specular, with the index of the medium outside. f90 is its factor.
        float f0 = dielectricF0(b.eta.y);
        if (hasLobe(features, GLINT_SPECULAR)) {
            vec3 specularColor = GLINT_MATERIAL_SPECULAR_COLOR_FACTOR(hit);
            scaleByColorTexture(hit, features, specularColor);
            b.f0 = min(f0 * specularColor, vec3(1.0)) * b.f90;
        } else {
            b.f0 = vec3(f0 * b.f90);
        }
    }
}
