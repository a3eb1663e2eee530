// What Glint's own base lets through on a straight line, where no hit is fetched: for rays of lights.
#include "bsdf/features.glsl"
#include "bsdf/fresnel.glsl"
#include "hit/surface_point.glsl"
#include "host/material.glsl"

#if GLINT_SHADOW_GLASS

// The share that the interface lets straight through, computed as for visible surfaces (hit/material.glsl), but with
// the mesh's own normal, and without coats and films. `cosine` is that between the normal and the ray.
vec3 sharePastInterface(SurfacePoint point, Features features, vec3 color, float cosine) {
    float transmission = GLINT_MATERIAL_TRANSMISSION_FACTOR(point);
    if (inputOfKey(features, GLINT_TRANSMISSION_TEXTURE)) {
        transmission *= samplePoint(point, kTransmissionTexture, features).r;
    }
    bool glossy = lobeOfKey(features, GLINT_SPECULAR_GLOSSINESS);
    float metallic = glossy ? 0.0 : GLINT_MATERIAL_METALLIC_FACTOR(point);
    vec3 f0 = glossy ? GLINT_MATERIAL_GLOSSY_SPECULAR_FACTOR(point) : vec3(0.04);
    float f90 = 1.0;
    if (inputOfKey(features, GLINT_METALLIC_ROUGHNESS_TEXTURE)) {
        vec4 texel = samplePoint(point, kMetallicRoughnessTexture, features);
        metallic *= texel.b;
        f0 *= glossy ? texel.rgb : vec3(1.0);
    }
    if (lobeOfKey(features, GLINT_IOR)) {
        f0 = vec3(dielectricF0(GLINT_MATERIAL_IOR(point)));
    }
    if (lobeOfKey(features, GLINT_SPECULAR)) {
        float specular = GLINT_MATERIAL_SPECULAR_FACTOR(point);
        vec3 specularColor = GLINT_MATERIAL_SPECULAR_COLOR_FACTOR(point);
        if (inputOfKey(features, GLINT_SPECULAR_TEXTURE)) {
            specular *= samplePoint(point, kSpecularTexture, features).a;
        }
        if (inputOfKey(features, GLINT_SPECULAR_COLOR_TEXTURE)) {
            specularColor *= samplePoint(point, kSpecularColorTexture, features).rgb;
        }
        f0 = min(f0 * specularColor, vec3(1.0)) * specular;
        f90 = specular;
    }
    return color * ((1.0 - metallic) * transmission * schlickPassed(f0, f90, cosine));
}

// The absorption per metre of the medium that the surface bounds (boundsAbsorberOfKey()).
vec3 absorptionAt(SurfacePoint point) {
    return GLINT_MATERIAL_ABSORPTION(point);
}

#endif
