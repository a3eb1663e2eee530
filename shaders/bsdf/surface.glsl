// What shading needs of a surface once its textures are read, and its response to light.
#include "bsdf/constants.glsl"
#include "bsdf/fresnel.glsl"
#include "bsdf/ggx.glsl"

struct Surface {
    vec3 diffuseAlbedo;
    vec3 f0;  // reflectance at normal incidence
    float roughness;
    float alpha;  // roughness², at least kMinAlpha
    vec3 normal;  // shading normal, unit, on the viewer's side
    vec3 emission;
    float occlusion;  // of ambient light only
};

// cos(n, v) is at least this: bounds the visibility term where an interpolated normal turns from the viewer.
const float kMinNDotV = 1e-4;
// Bounds the NDF's peak, 1 / (π alpha²), to 3.2e7, far within the range of half and single precision products.
const float kMinAlpha = 1e-4;

float clampedNDotV(Surface surface, vec3 view) {
    return clamp(dot(surface.normal, view), kMinNDotV, 1.0);
}

// BSDF times cos(n, l): glTF 2.0, appendix B.3.5. view and light are unit and point away from the surface.
vec3 evaluateBsdf(Surface surface, vec3 view, vec3 light) {
    float nDotL = dot(surface.normal, light);
    if (nDotL <= 0.0) {
        return vec3(0.0);
    }
    vec3 halfVector = normalize(view + light);
    vec3 fresnel = fresnelSchlick(surface.f0, max(dot(view, halfVector), 0.0));
    float specular = ggxDistribution(surface.normal, halfVector, surface.alpha) *
                     ggxVisibility(nDotL, clampedNDotV(surface, view), surface.alpha);
    vec3 diffuse = surface.diffuseAlbedo * kInversePi;
    return (mix(diffuse, vec3(specular), fresnel)) * nDotL;
}
