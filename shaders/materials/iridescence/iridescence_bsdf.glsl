// KHR_materials_iridescence: a film on each base. As in the reference renderer, the angle of the view serves for all
// lights.
#include "hit/surface_values.glsl"
#include "materials/iridescence/iridescence.glsl"

// The f0 of a base under a film of the given coverage and thickness. The film's reflectance is turned into the f0 with
// which Schlick's approximation gives it, so that the albedos of the lobe are still known.
GLINT_RELAXED vec3 filmF0(GLINT_RELAXED vec3 f0, GLINT_RELAXED float f90, float nDotV, float ior, float thickness,
                          GLINT_RELAXED float coverage) {
    vec3 film = iridescentFresnel(nDotV, f0, ior, thickness);
    return mix(f0, min(schlickF0(film, f90, nDotV), vec3(f90)), coverage);
}

void iridescenceBsdf(Hit hit, Features features, inout SurfaceValues values, inout Surface surface) {
    float nDotV = clamp(dot(surface.normal, hit.view), 0.0, 1.0);
    GLINT_RELAXED float factor = GLINT_MATERIAL_IRIDESCENCE_FACTOR(hit);
    float thickness = GLINT_MATERIAL_IRIDESCENCE_THICKNESS_MAXIMUM(hit);
    if (hasInput(features, GLINT_IRIDESCENCE_TEXTURE)) {
        factor *= sampleSlot(hit, kIridescenceTexture, features).r;
    }
    if (hasInput(features, GLINT_IRIDESCENCE_THICKNESS_TEXTURE)) {
        float thinnest = GLINT_MATERIAL_IRIDESCENCE_THICKNESS_MINIMUM(hit);
        vec4 texel = sampleSlot(hit, kIridescenceThicknessTexture, features);
        thickness = mix(thinnest, thickness, texel.g);
    }
    float filmIor = GLINT_MATERIAL_IRIDESCENCE_IOR(hit);
    surface.bsdf.base.f0 = filmF0(surface.bsdf.base.f0, surface.bsdf.base.f90, nDotV, filmIor, thickness, factor);
    if (hasInput(features, GLINT_PARTIAL_METAL)) {
        surface.bsdf.base.metalF0 = filmF0(surface.bsdf.base.metalF0, 1.0, nDotV, filmIor, thickness, factor);
    }
}
