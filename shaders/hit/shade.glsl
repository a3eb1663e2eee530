// shade(): the one function that every strategy calls for a hit. Here it answers with the light that comes back.
#include "effects/ambient.glsl"
#include "generated/hit_effects.glsl"
#include "hit/answer_radiance.glsl"
#include "hit/material.glsl"
#include "host/lights.glsl"
#include "host/random.glsl"
#if GLINT_PATHS
#include "hit/path_sample.glsl"
#endif

// The dimensions of the random numbers of a sample.
const uint kDimensionLight = 0u;
const uint kDimensionHostLight = 1u;  // and the next two; three more for each further light
// The pairs of the sequence.
const uint kPairLightArea = 5u;

// The same dimension, of the bounce that is shaded.
uint shadingDimension(uint dimension) {
#if GLINT_PATHS
    return dimensionOfBounce(dimension);
#else
    return dimension;
#endif
}

// A light of the host's list.
HostLight lightOfHost(Hit hit, uint index) {
    uint dimension = shadingDimension(kDimensionHostLight + 3u * index);
    vec3 random = vec3(hostRandom(hit.target, dimension), hostRandom(hit.target, dimension + 1u),
                       hostRandom(hit.target, dimension + 2u));
    return hostLight(index, hit.position, random);
}

// The light of one light on a surface, without its shadow.
vec3 unshadowedLight(Hit hit, Surface surface, Features features, LightSample light) {
    return scatteredLight(surface, features, hit.geometricNormal, light.direction) * light.irradiance;
}

// Aims the shadow ray at the light's position, or at a point of a light that has a size.
void aimAtLight(Hit hit, HostLight light, inout ShadeResult result) {
    LightSample aim = hostSampleLight(light, hit.position);
#if GLINT_EFFECT_SHADOW
    if (hostLightHasSize(light)) {
        vec3 centre = aim.direction;
        aim = hostSampleLightPoint(light, aim, hostRandomPair(hit.target, shadingDimension(kPairLightArea)));
        if (aim.distance <= 0.0) {
            // The point is within the light.
            result.radiance += result.direct;
        } else if (dot(hit.geometricNormal, centre) * dot(hit.geometricNormal, aim.direction) <= 0.0) {
            // The surface itself hides the part of the light that is below it.
            aim.distance = 0.0;
        }
    }
#endif
    result.shadowDirection = aim.direction;
    result.shadowDistance = aim.distance;
}

// Direct light from one light. The light is chosen in one pass, with probability proportional to the luminance that it
// would bring without shadows (weighted reservoir sampling, Chao 1982). The result is unbiased, and exact if one light
// dominates.
void chooseLight(Hit hit, Surface surface, Features features, inout ShadeResult result) {
    float random = hostRandom(hit.target, shadingDimension(kDimensionLight));
    uint lights = hostLightCount(hit.position);
    float total = 0.0;
    float chosenWeight = 1.0;
    vec3 chosen = vec3(0.0);
    uint index = 0u;
    for (uint i = 0u; i < lights; ++i) {
        LightSample light = hostSampleLight(lightOfHost(hit, i), hit.position);
        vec3 contribution = unshadowedLight(hit, surface, features, light);
        float weight = luminance(contribution);
        if (weight <= 0.0) {
            continue;
        }
        total += weight;
        float probability = weight / total;
        if (random < probability) {
            random /= probability;
            chosen = contribution;
            chosenWeight = weight;
            index = i;
        } else {
            random = (random - probability) / (1.0 - probability);
        }
    }
    result.direct = chosen * (total / chosenWeight);
    if (total > 0.0) {
        aimAtLight(hit, lightOfHost(hit, index), result);
    }
}

#if GLINT_PATHS

// Lights a surface that is lit. The path's next ray finds the light of the sky and of other surfaces; only at the last
// bounce the sky stands in for them.
ShadeResult shadeSurface(Hit hit, Surface surface, Features features) {
    ShadeResult result = darkness();
    SkyShares sky = wholeSky();
    if (GLINT_FRAME.bounce == 1u) {
        changeSkyOfHit(hit, features, sky);
    }
    result.radiance = surface.emission;
    chooseLight(hit, surface, features, result);
    if (pathGoesOn()) {
        // An effect that has traced the transmitted light itself leaves none.
        surface.bsdf.transmitted *= sky.transmitted;
        result.path = nextStep(hit, surface, features, arrivingShare(hit.arrival, hit.position));
    } else {
        result.radiance += ambientLight(surface, features, hit.view, sky);
    }
    return result;
}

#else

// Lights a surface that is lit.
ShadeResult shadeSurface(Hit hit, Surface surface, Features features) {
    ShadeResult result = darkness();
    SkyShares sky = wholeSky();
    changeSkyOfHit(hit, features, sky);
    result.radiance = surface.emission + ambientLight(surface, features, hit.view, sky);
    chooseLight(hit, surface, features, result);
    return result;
}

#endif

// Returns the light of the hit by itself, whatever path led to it.
ShadeResult shadeAlone(Hit hit, Features features) {
    if (hasLobe(features, GLINT_UNLIT)) {
        ShadeResult result = darkness();
        result.radiance = surfaceValues(hit, features).color.rgb;
        return result;
    }
    return shadeSurface(hit, evaluateSurface(hit, features), features);
}

#if GLINT_PATHS

// Returns what of that light arrives at the primary surface.
ShadeResult shade(Hit hit, Features features) {
    vec3 arriving = arrivingShare(hit.arrival, hit.position);
    if (hit.arrival.medium != 0u && !hit.frontFace && !showsBack(features)) {
        // Only rays within a volume meet the back of a single-sided surface. It is not there.
        ShadeResult result = darkness();
        if (pathGoesOn()) {
            result.path = straightStep(hit, arriving);
        }
        return result;
    }
    ShadeResult result = shadeAlone(hit, features);
    result.radiance *= arriving;
    result.direct *= arriving;
    return result;
}

#else

ShadeResult shade(Hit hit, Features features) {
    return shadeAlone(hit, features);
}

#endif
