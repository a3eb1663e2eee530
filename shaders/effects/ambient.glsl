// The sky's light on a surface, for the part that no rays bring.
#include "effects/sky.glsl"
#include "effects/sky_shares.glsl"
#include "hit/geometry.glsl"
#include "hit/surface.glsl"

// The mirror direction. An anisotropic lobe spreads across its grooves, so the normal bends towards the view within the
// plane of the grooves' normals (KHR_materials_anisotropy, implementation notes).
vec3 ambientMirror(Surface surface, Features features, vec3 view) {
    vec3 normal = surface.normal;
    if (hasLobe(features, GLINT_ANISOTROPY)) {
        vec3 across = cross(cross(surface.bitangent, view), surface.bitangent);
        float bend = (surface.bsdf.alpha.x - surface.bsdf.alpha.y) * (1.0 - surface.roughness * surface.roughness);
        normal = directionOr(mix(normal, directionOr(across, normal), bend), normal);
    }
    return reflect(-view, normal);
}

// The sky behind the surface, through the microfacets. A thin wall does not bend the view; a volume bends it where it
// enters.
vec3 skyBehind(Surface surface, Features features, float eta) {
    vec3 direction = -surface.bsdf.view;
    if (hasLobe(features, GLINT_VOLUME) && refracts(eta) &&
        !refractDirection(surface.bsdf.view, vec3(0.0, 0.0, 1.0), eta, direction)) {
        return vec3(0.0);
    }
    return skyAround(toWorld(surface, direction), surface.roughness);
}

vec3 ambientTransmission(Surface surface, Features features) {
    Bsdf bsdf = surface.bsdf;
    vec3 behind = skyBehind(surface, features, bsdf.eta.y);
    if (hasLobe(features, GLINT_DISPERSION)) {
        behind.x = skyBehind(surface, features, bsdf.eta.x).x;
        behind.z = skyBehind(surface, features, bsdf.eta.z).z;
    }
    // Without compensation, the loss of single scattering is subtracted too.
    GLINT_RELAXED float dropped = GLINT_ENERGY_COMPENSATION != 0 ? 0.0 : bsdf.viewLoss;
    return bsdf.transmitted * behind * max(diffusePassed(surface) - dropped, 0.0);
}

vec3 ambientLight(Surface surface, Features features, vec3 view, SkyShares sky) {
    GLINT_RELAXED vec3 albedo = specularAlbedo(surface.bsdf, features, surface.bsdf.viewLoss, surface.bsdf.viewBias);
    GLINT_RELAXED vec3 first = singleScatterAlbedo(surface.bsdf, features, surface.bsdf.viewLoss, surface.bsdf.viewBias);
    GLINT_RELAXED vec3 reflected = albedo - first * (1.0 - sky.mirrored);
    GLINT_RELAXED float below = diffusePassed(surface);
    // The occlusion texture describes the outside, and so do the rays of ambient occlusion.
    GLINT_RELAXED float open = surface.occlusion * sky.open;
    vec3 front = surface.bsdf.diffuse * (below * sky.diffuse) * skyIrradianceOverPi(surface.normal) +
                 reflected * skyAround(ambientMirror(surface, features, view), surface.roughness);
    vec3 back = vec3(0.0);
    if (hasLobe(features, GLINT_TRANSMISSION) && sky.transmitted > 0.0) {
        back += ambientTransmission(surface, features) * sky.transmitted;
    }
    if (hasLobe(features, GLINT_DIFFUSE_TRANSMISSION)) {
        back += surface.bsdf.diffuseTransmitted * (below * sky.diffuse) * skyIrradianceOverPi(-surface.normal);
    }
    vec3 result = (front * open + back) * baseShare(surface, features);
    GLINT_RELAXED float coat = coatReflectance(surface, features);
    if (hasLobe(features, GLINT_SHEEN)) {
        result += surface.bsdf.sheenColor * min(surface.bsdf.sheenAlbedo, 1.0) * skyIrradianceOverPi(surface.normal) *
                  (open * (1.0 - coat));
    }
    if (hasLobe(features, GLINT_CLEARCOAT)) {
        vec3 direction = reflect(-view, toWorld(surface, surface.bsdf.clearcoatNormal));
        result += skyAround(direction, sqrt(surface.bsdf.clearcoatAlpha)) * (coat * sky.coated * open);
    }
    return result;
}
