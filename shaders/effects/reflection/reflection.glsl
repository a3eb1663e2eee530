// The effect reflection: decides which surfaces send a ray, which ray, and its weight.
#include "bsdf/sample.glsl"
#include "effects/sample.glsl"
#include "effects/sky_shares.glsl"
#include "generated/layers_traced.glsl"
#include "hit/bindings.glsl"
#include "hit/geometry.glsl"
#include "host/random.glsl"
#include "hit/surface.glsl"

// The share of a uniform white sky that the base reflects at the first bounce, through the layers above it.
vec3 firstBounce(Surface surface, Features features) {
    return singleScatterAlbedo(surface.bsdf.base, features) * baseShare(surface, features);
}

// The base's lobe at the first bounce, times n·l, through the layers above it; l.z > 0.
vec3 baseLobe(Surface surface, Features features, vec3 l, out float pdf) {
    Bsdf b = surface.bsdf;
    Facet facet = facetBetween(b.base, features, b.view, l);
    pdf = mirroredPdf(b.view, facet.h, b.base.alpha);
    return facet.fresnel * (ggxDistribution(facet.h, b.base.alpha) * ggxVisibility(l, b.view, b.base.alpha) * l.z) *
           baseShare(surface, features);
}

#if GLINT_SHARED_LIGHTS
// The rays that the surface at hand sends.
struct ReflectionRay {
    TracedLayers layers;
    float baseChance;  // that the ray is one of the base, if that is no mirror
    bool isMirror;     // it goes to the one direction of a mirror
};
ReflectionRay reflectionRay;
#endif

// A ray in the mirror direction about `normal`, whatever its pdf is. A flat mirror continues the pixel's cone.
EffectSample mirrorSample(Hit hit, vec3 normal, vec3 weight) {
    vec3 direction = onSide(reflect(-hit.view, normal), hit.geometricNormal);
    return sentSample(hit, direction, weight, GLINT_FRAME.pixelSpread);
}

// The pairs of dimensions of the sequence.
const uint kPairDirection = 0u;
const uint kPairLobe = 1u;

// Samples a direction of the base or of a layer, by one-sample multiple importance sampling (Veach 1997, balance
// heuristic). A mirror has no density that could be combined with that of a glossy direction. The base's lobe has the
// share and the chance given.
EffectSample glossySample(Hit hit, Surface surface, Features features, TracedLayers layers, float traced, float chance,
                          uint chosen) {
    Bsdf b = surface.bsdf;
    vec2 u = hostRandomPair(hit.target, kPairDirection);
    vec3 l = chosen == kChosenBase ? reflectAbout(b.view, sampleVisibleNormal(b.view, b.base.alpha, u))
                                   : sampleTracedLayer(surface, features, chosen, u);
    if (chosen == kChosenBase ? l.z <= 0.0 : l == vec3(0.0)) {
        // The facet sends the view to other facets. Energy compensation accounts for that light.
        return noSample(kRayBlack);
    }
    vec3 weight = vec3(0.0);
    float pdf = 0.0;
    if (chance > 0.0 && l.z > 0.0) {
        float basePdf;
        weight += traced * baseLobe(surface, features, l, basePdf);
        pdf += chance * basePdf;
    }
    addTracedLayers(surface, features, layers, l, weight, pdf);
    vec3 direction = onSide(toWorld(surface, l), hit.geometricNormal);
    return sentSample(hit, direction, pdf > 0.0 ? weight / pdf : vec3(0.0), GLINT_FRAME.pixelSpread);
}

// Samples one ray for some lobe within the roughness limit. A lobe below the mirror limit reflects exactly; between the
// limits its visible normals are sampled. `traced` is the share of the base's reflection at the first bounce that rays
// bring.
EffectSample sampleLobes(Hit hit, Surface surface, Features features, float traced, TracedLayers layers) {
    vec3 base = traced * firstBounce(surface, features);
    bool baseMirror = isMirror(surface.roughness);
    weighLayers(layers, features, baseMirror, base);
    float ofLayers = sumOfLayers(layers);
    float brought = luminance(base) + ofLayers;
#if GLINT_SHARED_LIGHTS
    reflectionRay = ReflectionRay(layers, baseMirror ? 0.0 : 1.0, baseMirror);
#endif
    if (brought <= 0.0) {
        return noSample(traced > 0.0 ? kRayBlack : kRayRough);
    }
    uint chosen = kChosenBase;
    float chance = 1.0;
    if (ofLayers > 0.0) {
        float random = hostRandomPair(hit.target, kPairLobe).x;
        TracedLayer layer;
        chosen = chooseLayer(layers, features, brought, random, layer);
        chance = 1.0 - ofLayers / brought;
#if GLINT_SHARED_LIGHTS
        reflectionRay = ReflectionRay(layers, baseMirror ? 0.0 : chance,
                                      chosen == kChosenBase ? baseMirror : layer.isMirror);
#endif
        if (chosen != kChosenBase && layer.isMirror) {
            return mirrorSample(hit, toWorld(surface, layer.normal), layer.light / layer.chance);
        }
    }
    if (chosen == kChosenBase && baseMirror) {
        return mirrorSample(hit, surface.normal, base / chance);
    }
    return glossySample(hit, surface, features, layers, traced, baseMirror ? 0.0 : chance, chosen);
}

EffectSample sampleReflection(Hit hit, Surface surface, Features features, inout SkyShares sky) {
    float traced = tracedShare(surface.roughness);
    sky.mirrored = 1.0 - traced;
    TracedLayers layers = traceLayers(surface, features, sky.layers);
    return sampleLobes(hit, surface, features, traced, layers);
}

#if GLINT_SHARED_LIGHTS

// The density of rays to other directions than a mirror's, by solid angle.
float glossyDensity(Surface surface, Features features, vec3 l) {
    vec3 light = vec3(0.0);
    float density = 0.0;
    if (reflectionRay.baseChance > 0.0 && l.z > 0.0) {
        density = reflectionRay.baseChance *
                  mirroredPdf(surface.bsdf.view, normalize(surface.bsdf.view + l), surface.bsdf.base.alpha);
    }
    addTracedLayers(surface, features, reflectionRay.layers, l, light, density);
    return density;
}

// The density of the ray that was sent; 0 if it is a mirror's, or if its end may be found on the screen, where the
// emission's part of the light is unknown.
float densityReflection(Surface surface, Features features, vec3 l) {
    return reflectionRay.isMirror || GLINT_FRAME.screenSteps != 0u ? 0.0 : glossyDensity(surface, features, l);
}

void shareReflection(Surface surface, Features features, vec3 l, float lights, inout SkyShares shares) {
    if (GLINT_FRAME.screenSteps != 0u) {
        return;
    }
    float part = lights / (lights + glossyDensity(surface, features, l));
    if (reflectionRay.baseChance > 0.0) {
        shares.mirrored += (1.0 - shares.mirrored) * part;
    }
    shareTracedLayers(features, reflectionRay.layers, part, shares.layers);
}

#endif
