// Reads the parameters of the coat, and colours and darkens what is below it: OpenPBR 1.1, "Coat", with the draft's
// names.
#include "hit/surface_values.glsl"

void coatBsdf(Hit hit, Features features, inout SurfaceValues values, inout Surface surface) {
    float factor = GLINT_MATERIAL_COAT_FACTOR(hit);
    if (GLINT_HAS_COAT_TEXTURE(features)) {
        factor *= sampleSlot(hit, kCoatTexture, features).r;
    }
    float roughness = GLINT_MATERIAL_COAT_ROUGHNESS_FACTOR(hit);
    float ior = GLINT_MATERIAL_COAT_IOR(hit);
    float f0 = GLINT_MATERIAL_COAT_F0(hit);
    surface.bsdf.layers.coat = Coat(factor, max(roughness * roughness, kMinAlpha), f0, 0.0);

    // The colour is that of light which passes straight down and up. A slanted way through the coat is longer.
    float cosine = dot(surface.normal, hit.view);
    float sine2 = (1.0 - cosine * cosine) / (ior * ior);
    float way = 0.5 + 0.5 / sqrt(max(1.0 - sine2, 1e-4));
    vec3 tint = pow(GLINT_MATERIAL_COAT_COLOR_FACTOR(hit), vec3(way));
    // Light that the coat's inner side reflects meets the base again and again. K is the share of it for diffuse light,
    // and for light that a smooth base mirrors the Fresnel reflectance: the roughness of the base chooses between them.
    float inner = 1.0 - (1.0 - f0) / (ior * ior);
    vec3 base = mix(surface.bsdf.diffuse + surface.bsdf.f0 * (1.0 - surface.bsdf.diffuse), values.color.rgb,
                    values.metallic);
    float k = mix(f0, inner, values.roughness);
    vec3 darkening = mix(vec3(1.0), (1.0 - k) / (vec3(1.0) - clamp(base, 0.0, 1.0) * k),
                         GLINT_MATERIAL_COAT_DARKENING_FACTOR(hit));
    vec3 below = mix(vec3(1.0), tint * darkening, factor);
    surface.bsdf.diffuse *= below;
    surface.bsdf.f0 *= below;
    surface.bsdf.f90 *= largest(below);
    surface.bsdf.metalF0 *= below;
}
