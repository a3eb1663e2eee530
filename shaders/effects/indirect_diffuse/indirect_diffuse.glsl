// The effect indirect diffuse: light that reaches the diffuse lobes after one bounce, or from the sky. It replaces the
// sky's light without occlusion.
#include "bsdf/sample.glsl"
#include "effects/sample.glsl"
#include "effects/sky_shares.glsl"
#include "host/random.glsl"
#include "hit/surface.glsl"

// The pairs of dimensions of the sequence.
const uint kPairIndirect = 3u;
const uint kPairIndirectSide = 4u;

// The growth of a ray's cone in a metre. The rays of one pixel go everywhere, and their result is a mean. An eighth of
// a radian keeps out the finest texture levels, which would only make noise.
const float kIndirectSpread = 0.125;

#if GLINT_SHARED_LIGHTS
// The probability that the surface at hand sends its ray to the far side.
float indirectFarChance = 0.0;
#endif

// Sends a ray in a direction that a model samples itself, so that its mirrors and its glass show what is around them.
EffectSample sampleOfModel(Hit hit, Surface surface, Features features) {
    Bsdf b = surface.bsdf;
    vec3 local = sampleModel(b.layers, features, b.view, hostRandomPair(hit.target, kPairIndirect));
    float density = local != vec3(0.0) ? modelDensity(b.layers, features, b.view, local) : 0.0;
    if (density <= 0.0 || (local.z < 0.0 && !transmits(features))) {
        return noSample(kRayBlack);
    }
#if GLINT_SHARED_LIGHTS
    vec3 light = evaluateDiffuse(b, features, local) * (abs(local.z) * kInversePi);
#else
    vec3 light = evaluateBase(b, features, local) * baseShare(surface, features);
#endif
    vec3 direction = onSide(toWorld(surface, local), local.z < 0.0 ? -hit.geometricNormal : hit.geometricNormal);
    return sentSample(hit, direction, light / density,
                      max(min(kIndirectSpread, inversesqrt(density)), GLINT_FRAME.pixelSpread));
}

// Sends one cosine-weighted ray on the viewer's side, or on the far side through a surface that scatters light to it.
// The weights are those of the sky's light (effects/ambient.glsl), so that an empty scene looks the same; or those of
// the BSDF, where samples of lights bring a part of the same light.
EffectSample sampleIndirectDiffuse(Hit hit, Surface surface, Features features, inout SkyShares sky) {
    vec3 base = baseShare(surface, features) * vec3(diffusePassed(surface.bsdf.base));
    vec3 front = surface.bsdf.diffuse * base;
    vec3 back = vec3(0.0);
    if (scattersBehind(features)) {
        back = surface.bsdf.diffuseTransmitted * base;
    }
    sky.diffuse = 0.0;
    sky.behind = 0.0;
    float total = luminance(front) + luminance(back);
    if (total <= 0.0) {
        return noSample(kRayAbsent);
    }
    if (samplesModel(features)) {
        return sampleOfModel(hit, surface, features);
    }
    float chance = luminance(back) / total;
#if GLINT_SHARED_LIGHTS
    indirectFarChance = chance;
#endif
    bool passes = chance > 0.0 && hostRandomPair(hit.target, kPairIndirectSide).x < chance;
    vec3 local = sampleCosine(hostRandomPair(hit.target, kPairIndirect));
    vec3 direction = onSide(toWorld(surface, passes ? vec3(local.xy, -local.z) : local),
                            passes ? -hit.geometricNormal : hit.geometricNormal);
#if GLINT_SHARED_LIGHTS
    vec3 weight = evaluateDiffuse(surface.bsdf, features, passes ? vec3(local.xy, -local.z) : local) /
                  (passes ? chance : 1.0 - chance);
#else
    vec3 weight = passes ? back / chance : front / (1.0 - chance);
#endif
    return sentSample(hit, direction, weight, max(kIndirectSpread, GLINT_FRAME.pixelSpread));
}

#if GLINT_SHARED_LIGHTS

// The density of the ray that was sent, by solid angle.
float densityIndirectDiffuse(Surface surface, Features features, vec3 l) {
    if (samplesModel(features)) {
        return modelDensity(surface.bsdf.layers, features, surface.bsdf.view, l);
    }
    return (l.z > 0.0 ? 1.0 - indirectFarChance : indirectFarChance) * abs(l.z) * kInversePi;
}

void shareIndirectDiffuse(Surface surface, Features features, vec3 l, float lights, inout SkyShares shares) {
    float part = lights / (lights + densityIndirectDiffuse(surface, features, l));
    shares.diffuse += (1.0 - shares.diffuse) * part;
    shares.behind += (1.0 - shares.behind) * part;
}

#endif
