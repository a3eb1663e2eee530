// Light of the sky on a surface that traces no ray for it.
#include "bsdf/surface.glsl"
#include "effects/sky.glsl"

vec3 ambientDiffuse(Surface surface) {
    return surface.diffuseAlbedo * skyIrradianceOverPi(surface.normal) * surface.occlusion;
}

// The sky in the mirror direction; a rough lobe sees the sky's mean around it.
vec3 ambientSpecular(Surface surface, vec3 view) {
    vec3 mirrored = reflect(-view, surface.normal);
    vec3 sky = mix(skyRadiance(mirrored), skyIrradianceOverPi(mirrored), surface.roughness);
    return ggxDirectionalAlbedo(surface.f0, surface.roughness, clampedNDotV(surface, view)) * sky *
           surface.occlusion;
}
