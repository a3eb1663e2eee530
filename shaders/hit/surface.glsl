// What shading needs of a surface once its textures are read.
#include "bsdf/bsdf.glsl"

struct Surface {
    Bsdf bsdf;       // prepared for the view
    vec3 tangent;    // x, y and z of the BSDF's frame, world
    vec3 bitangent;
    vec3 normal;     // on the viewer's side
    float roughness; // sqrt of the larger alpha
    vec3 emission;
    GLINT_RELAXED float occlusion; // of ambient light only
};

vec3 toSurface(Surface surface, vec3 direction) {
    return vec3(dot(surface.tangent, direction), dot(surface.bitangent, direction), dot(surface.normal, direction));
}

vec3 toWorld(Surface surface, vec3 direction) {
    return direction.x * surface.tangent + direction.y * surface.bitangent + direction.z * surface.normal;
}

// BSDF times |n·l|, reflected or let through, for light from a direction of the world. geometricNormal is on the
// viewer's side: where it and the shading normal differ on which side the light is, there is none, or it would leak
// through the surface.
vec3 scatteredLight(Surface surface, Features features, vec3 geometricNormal, vec3 toLight) {
    vec3 l = toSurface(surface, toLight);
    return l.z * dot(geometricNormal, toLight) > 0.0 ? evaluateBsdf(surface.bsdf, features, l) : vec3(0.0);
}

// What the coat reflects of a uniform white sky, and 0 without one.
GLINT_RELAXED float coatReflectance(Surface surface, Features features) {
    return hasLobe(features, GLINT_CLEARCOAT) ? clearcoatFresnel(surface.bsdf.clearcoat, coatViewCosine(surface.bsdf))
                                              : 0.0;
}

// Share of what the base reflects or lets through that coat and sheen let out again.
GLINT_RELAXED float baseShare(Surface surface, Features features) {
    GLINT_RELAXED float share = 1.0 - coatReflectance(surface, features);
    if (hasLobe(features, GLINT_SHEEN)) {
        share *= belowSheen(surface.bsdf, surface.bsdf.sheenAlbedo);
    }
    return share;
}

// Share of the light of a uniform sky that the microfacets let in to the diffuse lobes.
GLINT_RELAXED float diffusePassed(Surface surface) {
    return max(smallest(specularPassed(surface.bsdf, surface.bsdf.viewLoss, surface.bsdf.viewBias)), 0.0);
}
