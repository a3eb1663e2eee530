// The sky's light on a surface, for the part that no rays bring. In packages whose sky is a light (--sky-light),
// samples of the sky bring most of that part, and leave only light that they would hardly find.
#include "bsdf/ggx.glsl"
#include "host/sky.glsl"
#include "effects/sky_shares.glsl"
#include "generated/layers_sky.glsl"
#include "hit/geometry.glsl"
#include "hit/surface.glsl"

// The number of directions in which an anisotropic lobe reads the sky.
const int kLobeTaps = 16;

// The roughness whose lobe about a direction stands for a sample of this density. Seen head on, a lobe has a density of
// (1 + alpha²) / (4π alpha²) at its centre.
float tapRoughness(float pdf) {
    float filled = min(1.0 / (4.0 * kPi * float(kLobeTaps) * max(pdf, 1e-6)), 0.5);
    return sqrt(sqrt(filled / (1.0 - filled)));
}

// The mean of the sky over an anisotropic lobe at the first bounce, by filtered importance sampling (Křivánek and
// Colbert 2008, "Real-time Shading with Filtered Importance Sampling"). Hammersley's points choose visible normals.
// Each direction reads the level of the map whose lobe fills its share of the solid angle. Fresnel does not weight
// them, because the albedo has it.
vec3 skyAroundLobe(Surface surface) {
    Bsdf b = surface.bsdf;
    vec3 sum = vec3(0.0);
    float total = 0.0;
    for (int i = 0; i < kLobeTaps; ++i) {
        vec2 u = vec2(float(bitfieldReverse(uint(i))) * 2.3283064e-10, float(i) / float(kLobeTaps));
        vec3 h = sampleVisibleNormal(b.view, b.base.alpha, u + vec2(0.5 / float(kLobeTaps)));
        vec3 l = reflect(-b.view, h);
        // G₂ / G₁. Light from below is masked.
        float weight = max(l.z, 0.0) * ggxVisibility(l, b.view, b.base.alpha);
        sum += weight * hostSkyAround(toWorld(surface, l), tapRoughness(mirroredPdf(b.view, h, b.base.alpha)));
        total += weight;
    }
    return sum / max(total, 1e-12);
}

#if GLINT_SKY_LIGHT

// Samples of the sky leave lobes of a lower roughness to the ambient light. At this roughness a metal's lobe is some 40
// times as dense as samples of a uniform sky.
const float kLeastSampledRoughness = 0.4;

// Returns the shares of `sky`, which no ray brings, that the ambient light brings: smooth reflection, and transmission
// through microfacets, because shadow rays do not see through volumes.
SkyShares ambientShares(Surface surface, Features features, SkyShares sky) {
    sky.diffuse = 0.0;
    sky.behind = 0.0;
    sky.mirrored *= surface.roughness < kLeastSampledRoughness ? 1.0 : 0.0;
    sky.layers = smoothLayerShares(surface, features, sky.layers, kLeastSampledRoughness);
    return sky;
}

// Returns the part of `shares` that samples of the sky bring, where `sky` is the share that no ray brings.
SkyShares sampledShares(Surface surface, Features features, SkyShares shares, SkyShares sky) {
    SkyShares ambient = ambientShares(surface, features, sky);
    shares.mirrored -= ambient.mirrored;
    shares.transmitted -= ambient.transmitted;
    shares.layers = lessLayerShares(shares.layers, ambient.layers);
    return shares;
}

#endif

// The light that the microfacets reflect of the sky. `mirrored` is the share of the first bounce that the sky brings.
vec3 ambientReflection(Surface surface, Features features, vec3 view, GLINT_RELAXED float mirrored) {
    GLINT_RELAXED vec3 all = specularAlbedo(surface.bsdf.base, features);
    GLINT_RELAXED vec3 first = singleScatterAlbedo(surface.bsdf.base, features);
#if GLINT_SKY_LIGHT
    // Samples of the sky bring the light that bounces between microfacets.
    all = first;
#endif
    if (isAnisotropic(features)) {
        // Later bounces have nearly forgotten the view.
        vec3 again = (all - first) * hostSkyIrradianceOverPi(surface.normal);
        return mirrored > 0.0 ? again + first * mirrored * skyAroundLobe(surface) : again;
    }
    return (all - first * (1.0 - mirrored)) * hostSkyAround(reflect(-view, surface.normal), surface.roughness);
}

// The sky behind the surface, through the microfacets. A thin wall does not bend the view; a volume bends it where it
// enters.
vec3 skyBehind(Surface surface, Features features, float eta) {
    vec3 direction = -surface.bsdf.view;
    if (boundsMedium(features) && refracts(eta) &&
        !refractDirection(surface.bsdf.view, vec3(0.0, 0.0, 1.0), eta, direction)) {
        return vec3(0.0);
    }
    return hostSkyAround(toWorld(surface, direction), surface.roughness);
}

// `below` is the share that passes the microfacets.
vec3 ambientTransmission(Surface surface, Features features, GLINT_RELAXED float below) {
    Base b = surface.bsdf.base;
    bool spreads = dispersesLight(features);
    vec3 behind = vec3(0.0);
    for (int channel = spreads ? 0 : 1; channel < (spreads ? 3 : 2); ++channel) {
        vec3 sky = skyBehind(surface, features, channelOf(b.eta, channel));
        behind = spreads ? withChannel(behind, channel, channelOf(sky, channel)) : sky;
    }
    // Without compensation, the loss of single scattering is subtracted too.
    GLINT_RELAXED float dropped = GLINT_ENERGY_COMPENSATION != 0 ? 0.0 : b.viewLoss;
    return b.transmitted * behind * max(below - dropped, 0.0);
}

vec3 ambientLight(Surface surface, Features features, vec3 view, SkyShares sky) {
#if GLINT_SKY_LIGHT
    sky = ambientShares(surface, features, sky);
#endif
    GLINT_RELAXED float below = diffusePassed(surface.bsdf.base);
    // The occlusion texture describes the outside, and so do the rays of ambient occlusion.
    GLINT_RELAXED float open = surface.occlusion * sky.open;
    vec3 front = surface.bsdf.diffuse * (below * sky.diffuse) * hostSkyIrradianceOverPi(surface.normal) +
                 ambientReflection(surface, features, view, sky.mirrored);
    vec3 back = vec3(0.0);
    if (passesFacets(features) && sky.transmitted > 0.0) {
        back += ambientTransmission(surface, features, below) * sky.transmitted;
    }
    if (scattersBehind(features)) {
        back += surface.bsdf.diffuseTransmitted * (below * sky.behind) * hostSkyIrradianceOverPi(-surface.normal);
    }
#if GLINT_SHADOW_GLASS
    back *= surface.unabsorbed;
#endif
    return addSkyOfLayers(surface, features, view, sky, open, front * open + back);
}
