// The effect reflection: decides which surfaces send a ray, which ray, and its weight.
#include "bsdf/sample.glsl"
#include "effects/sample.glsl"
#include "effects/sky_shares.glsl"
#include "hit/bindings.glsl"
#include "hit/geometry.glsl"
#include "hit/sequence.glsl"
#include "hit/surface.glsl"

// The share of a surface's reflection that its ray brings; the sky stands in for the rest. It falls to 0 over the last
// fifth below the roughness limit, so that no edge shows where a texture crosses the limit. Just below the limit a ray
// is still sent. With a limit of 1 every lobe is traced whole.
float tracedShare(float roughness) {
    float limit = GLINT_FRAME.maxReflectionRoughness;
    if (limit >= 1.0) {
        return 1.0;
    }
    if (roughness > limit) {
        return 0.0;
    }
    float fade = limit > 0.0 ? clamp((roughness - 0.8 * limit) / (0.2 * limit), 0.0, 0.999) : 0.0;
    return 1.0 - fade * fade * (3.0 - 2.0 * fade);
}

// The shares that the rays of a surface bring, on average over its samples.
struct TracedLobes {
    float base;  // of the base's reflection at the first bounce; the sky stands in for the rest
    float coat;  // of the coat's reflection
};

TracedLobes tracedLobes(Surface surface, Features features) {
    float coat = hasLobe(features, GLINT_CLEARCOAT) ? tracedShare(sqrt(surface.bsdf.clearcoatAlpha)) : 0.0;
    return TracedLobes(tracedShare(surface.roughness), coat);
}

bool isMirror(float roughness) {
    return roughness <= GLINT_FRAME.mirrorRoughness;
}

// The share of a uniform white sky that the base reflects at the first bounce, through coat and sheen.
vec3 firstBounce(Surface surface, Features features) {
    return singleScatterAlbedo(surface.bsdf, features, surface.bsdf.viewLoss, surface.bsdf.viewBias) *
           baseShare(surface, features);
}

// The base's lobe at the first bounce, times n·l, through coat and sheen; l.z > 0.
vec3 baseLobe(Surface surface, Features features, vec3 l, out float pdf) {
    Bsdf b = surface.bsdf;
    Facet facet = facetBetween(b, features, l);
    pdf = mirroredPdf(b.view, facet.h, b.alpha);
    return facet.fresnel * (ggxDistribution(facet.h, b.alpha) * ggxVisibility(l, b.view, b.alpha) * l.z) *
           baseShare(surface, features);
}

// A ray in the mirror direction about `normal`, whatever its pdf is. A flat mirror continues the pixel's cone.
EffectSample mirrorSample(Hit hit, vec3 normal, vec3 weight) {
    vec3 direction = onSide(reflect(-hit.view, normal), hit.geometricNormal);
    return sentSample(hit, direction, weight, GLINT_FRAME.pixelSpread);
}

// The pairs of dimensions of the sequence.
const uint kPairDirection = 0u;
const uint kPairLobe = 1u;

// Samples a direction of the coat or of the base, by one-sample multiple importance sampling (Veach 1997, balance
// heuristic). chances are those of base and coat; 0 for a lobe that has no density here.
EffectSample glossySample(Hit hit, Surface surface, Features features, TracedLobes traced, vec2 chances,
                          bool choosesCoat) {
    Bsdf b = surface.bsdf;
    vec2 u = sequencePair(hit.target, GLINT_FRAME.sampleIndex, GLINT_FRAME.seed, kPairDirection);
    vec3 l = choosesCoat ? sampleCoat(b, u) : reflectAbout(b.view, sampleVisibleNormal(b.view, b.alpha, u));
    if (choosesCoat ? l == vec3(0.0) : l.z <= 0.0) {
        // The facet sends the view to other facets. Energy compensation counts what becomes of that light.
        return noSample(kRayBlack);
    }
    vec3 weight = vec3(0.0);
    float pdf = 0.0;
    if (chances.x > 0.0 && l.z > 0.0) {
        float basePdf;
        weight += traced.base * baseLobe(surface, features, l, basePdf);
        pdf += chances.x * basePdf;
    }
    if (chances.y > 0.0) {
        weight += vec3(traced.coat * evaluateCoat(b, l));
        pdf += chances.y * coatPdf(b, l);
    }
    vec3 direction = onSide(toWorld(surface, l), hit.geometricNormal);
    return sentSample(hit, direction, pdf > 0.0 ? weight / pdf : vec3(0.0), GLINT_FRAME.pixelSpread);
}

// Samples one ray for some lobe within the roughness limit. A lobe below the mirror limit reflects exactly; between the
// limits its visible normals are sampled.
EffectSample sampleLobes(Hit hit, Surface surface, Features features, TracedLobes traced) {
    vec3 base = traced.base * firstBounce(surface, features);
    float coat = traced.coat * coatReflectance(surface, features);
    float brought = luminance(base) + coat;
    if (brought <= 0.0) {
        return noSample(traced.base > 0.0 ? kRayBlack : kRayRough);
    }
    bool baseMirror = isMirror(surface.roughness);
    bool coatMirror = isMirror(sqrt(surface.bsdf.clearcoatAlpha));
    float chance = 0.0;
    bool choosesCoat = false;
    if (hasLobe(features, GLINT_CLEARCOAT) && coat > 0.0) {
        if (baseMirror && coatMirror && surface.bsdf.clearcoatNormal.z > 0.99999) {
            // The two directions differ by less than a quarter of a degree, so one ray serves both.
            return mirrorSample(hit, surface.normal, base + vec3(coat));
        }
        chance = coat / brought;
        choosesCoat = sequencePair(hit.target, GLINT_FRAME.sampleIndex, GLINT_FRAME.seed, kPairLobe).x < chance;
    }
    if (choosesCoat && coatMirror) {
        return mirrorSample(hit, toWorld(surface, surface.bsdf.clearcoatNormal), vec3(coat / chance));
    }
    if (!choosesCoat && baseMirror) {
        return mirrorSample(hit, surface.normal, base / (1.0 - chance));
    }
    // A mirror has no density that could be combined with that of a glossy direction.
    vec2 chances = vec2(baseMirror ? 0.0 : 1.0 - chance, coatMirror ? 0.0 : chance);
    return glossySample(hit, surface, features, traced, chances, choosesCoat);
}

EffectSample sampleReflection(Hit hit, Surface surface, Features features, inout SkyShares sky) {
    TracedLobes traced = tracedLobes(surface, features);
    sky.mirrored = 1.0 - traced.base;
    sky.coated = 1.0 - traced.coat;
    return sampleLobes(hit, surface, features, traced);
}
