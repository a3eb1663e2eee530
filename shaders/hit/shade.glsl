// shade(): the one function that every strategy calls for a hit. Here it answers with the light that comes back.
#include "effects/ambient.glsl"
#include "generated/hit_effects.glsl"
#include "hit/answer_radiance.glsl"
#include "light/shared.glsl"
#include "hit/material.glsl"
#include "light/receiver.glsl"
#include "light/sized.glsl"
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
const uint kPairLightChoice = 0x10000u;  // and one more for each further light

// The same dimension, of the bounce that is shaded.
uint shadingDimension(uint dimension) {
#if GLINT_PATHS
    return dimensionOfBounce(dimension);
#else
    return dimension;
#endif
}

// A light of the host's list.
HostLight lightOfHost(Hit hit, Features features, uint index) {
    uint dimension = shadingDimension(kDimensionHostLight + 3u * index);
#if GLINT_LIGHT_SAMPLES > 0
    // The first numbers, which decide most, are well distributed.
    vec2 first = hostRandomPair(hit.target, shadingDimension(kPairLightChoice + index));
    return hostLight(index, receiverOf(hit, features), vec3(first, hostRandom(hit.target, dimension)));
#else
    vec3 random = vec3(hostRandom(hit.target, dimension), hostRandom(hit.target, dimension + 1u),
                       hostRandom(hit.target, dimension + 2u));
    return hostLight(index, hit.position, random);
#endif
}

// The light of one light on a surface, without its shadow.
vec3 unshadowedLight(Hit hit, Surface surface, Features features, LightSample light) {
    return scatteredLight(surface, features, hit.geometricNormal, light.direction) * light.irradiance;
}

#if GLINT_SHARED_LIGHTS

// Whether a ray of the path follows from the hit, which finds shared lights, too.
bool sendsRay() {
#if GLINT_PATHS
    return pathGoesOn();
#else
    return false;
#endif
}

// Leaves the lobes on which samples of the light bring its light. `sky` is what no ray of an effect brings.
void keepSampledLobes(Hit hit, Features features, HostLight light, SkyShares sky, inout Surface surface) {
    // An effect that follows the transmitted light finds shared lights itself.
    surface.bsdf.transmitted *= sky.transmitted;
#if GLINT_SKY_LIGHT
    if (light.emitter == kSkyEmitter) {
        if (!sendsRay()) {
            keepShares(sampledShares(surface, features, wholeSky(), wholeSky()), surface);
        }
#if GLINT_SHADOW_GLASS
        surface.bsdf.transmitted = vec3(0.0);
#endif
    }
#endif
#if GLINT_EMISSIVE_LIGHTS && GLINT_SHADOW_GLASS
    surface.bsdf.transmitted = vec3(0.0);
#endif
}

// A sample of a shared light at the hit of a ray: the shadow ray and the irradiance without a shadow, which comes from
// `direction` and which the lobes that `lit` keeps scatter. Where no ray follows, this sample counts alone. `part` is what
// of its light it counts for.
LightSample aimAtSharedFromHit(Hit hit, Features features, HostLight light, uint index, SkyShares sky,
                               inout Surface lit, out vec3 direction, out float part) {
    SharedSample drawn = sampleShared(hit, light, index, shadingDimension(0u));
    direction = drawn.direction;
    part = 1.0;
    LightSample aim = LightSample(vec3(0.0), 0.0, vec3(0.0), kRaySent);
    if (drawn.density <= 0.0) {
        return aim;
    }
#if GLINT_EMISSIVE_LIGHTS && GLINT_SHADOW_GLASS
    if (isWithinGlass(hit, features)) {
        return aim;
    }
#elif GLINT_SKY_LIGHT && GLINT_SHADOW_GLASS
    if (light.emitter == kSkyEmitter && isWithinGlass(hit, features)) {
        return aim;
    }
#endif
    aim = aimAtShared(hit, light, drawn);
    float density = drawn.density;
#if GLINT_PATHS
    if (pathGoesOn()) {
        Surface whole = lit;
        whole.bsdf.transmitted *= sky.transmitted;
        density += bsdfPdf(whole.bsdf, features, toSurface(lit, drawn.direction));
    }
#endif
    part = drawn.density / density;
    keepSampledLobes(hit, features, light, sky, lit);
    aim.irradiance = aim.distance > 0.0 ? drawn.radiance / density : vec3(0.0);
    return aim;
}

// What its shadow ray sees: as much as a ray of the path, or what rays to other lights see.
uint seenTowardsShared(Hit hit, Features features, HostLight light, vec3 direction, float part) {
    if (passesAsLight(light)) {
        return kShadowOfLight;
    }
#if GLINT_EMISSIVE_LIGHTS && GLINT_SHADOW_GLASS
    return (floatBitsToUint(1.0 / part) & ~kShadowKind) | kShadowPastGlass;
#elif GLINT_PATHS
    bool passes = dot(direction, hit.geometricNormal) < 0.0;
    return mediumBeyond(hit, features, passes) == 0u ? kShadowOfShared : kShadowOfSharedWithin;
#else
    return kShadowOfSharedWithin;
#endif
}

#endif

// The emission that the hit adds to the light of its ray.
vec3 countedEmission(Hit hit, Surface surface) {
#if GLINT_EMISSIVE_LIGHTS
    if (surface.emission != vec3(0.0)) {
        return surface.emission * emissionOfRay(hit);
    }
#endif
    return surface.emission;
}

// The same of a light that emits from no triangle, from its centre or from a point of a light that has a size. Where
// shadow rays pass glass, the surface that sent the ray has had the light of such lights behind this glass on the
// straight line, with all that happens within: it would count twice.
LightSample aimAtLight(Hit hit, Features features, HostLight light, inout Surface lit) {
    LightSample aim = hostSampleLight(light, hit.position);
#if GLINT_EFFECT_SHADOW
    // All lights may have the same numbers, because only one of them counts.
    if (hostLightHasSize(light)) {
        aim = hostSampleLightPoint(light, aim, hostRandomPair(hit.target, shadingDimension(kPairLightArea)));
    }
#endif
#if GLINT_SHADOW_GLASS
    if (hasLobe(features, GLINT_TRANSMISSION)) {
        if (isWithinGlass(hit, features)) {
            aim.irradiance = vec3(0.0);
        }
        lit.bsdf.transmitted = vec3(0.0);
    }
#endif
    return aim;
}

#if GLINT_SIZED_LIGHTS && GLINT_PATHS

// Returns whether samples alone bring the light from a side of the surface: with --shadow-through glass, what passes
// glass, which the surface that sent the ray has sampled (aimAtLight()).
bool isSampledAlone(Hit hit, Features features, bool passes) {
#if GLINT_SHADOW_GLASS
    return hasLobe(features, GLINT_TRANSMISSION) && (passes || isWithinGlass(hit, features));
#else
    return false;
#endif
}

#endif

#if GLINT_SIZED_LIGHTS

// The part of its light that the sample of a light counts for, on the lobes that `lit` keeps. The direction of the path
// brings the rest, and the walk of a refracted ray has found what passes the surface at which it ended.
float partOfSample(Hit hit, Surface surface, Features features, HostLight light, vec3 direction, SkyShares sky,
                   inout Surface lit) {
    float density = lobesFind(light) ? lightPointDensity(light, hostSampleLight(light, hit.position)) : 0.0;
    if (density <= 0.0) {
        return 1.0;
    }
    lit.bsdf.transmitted *= sky.transmitted;
#if GLINT_PATHS
    if (!isSampledAlone(hit, features, dot(direction, hit.geometricNormal) < 0.0)) {
        surface.bsdf.transmitted *= sky.transmitted;
        return density / (density + bsdfPdf(surface.bsdf, features, toSurface(surface, direction)));
    }
#endif
    return 1.0;
}

#endif

#if GLINT_SIZED_LIGHTS && GLINT_PATHS

// How many lights to look for in the direction of the path. A direction that the triangle's plane turns is none of the
// lobe's.
uint lightsInDirection(Hit hit, Surface surface, Features features, BsdfSample drawn) {
    bool passes = drawn.direction.z < 0.0 && transmits(features);
    float height = dot(toWorld(surface, drawn.direction), hit.geometricNormal) * (passes ? -1.0 : 1.0);
    bool looks = drawn.pdf > 0.0 && height > 0.0 && !isSampledAlone(hit, features, passes);
    return looks ? lightsToFind() : 0u;
}

// The point of a light that the direction meets, with the light that it brings to the viewer; black if it meets none.
LightSample foundOnPath(Hit hit, Surface surface, BsdfSample drawn, uint number) {
    HostLight light = lightToFind(number);
    LightSample centre = hostSampleLight(light, hit.position);
    LightSample point = lightAlong(light, centre, toWorld(surface, drawn.direction));
    float part = lobesFind(light) ? drawn.pdf / (drawn.pdf + lightPointDensity(light, centre)) : 0.0;
    point.irradiance *= drawn.weight * part;
    return point;
}

#endif

// Direct light from one light. The light is chosen in one pass, with probability proportional to the luminance that it
// would bring without shadows (weighted reservoir sampling, Chao 1982). The result is unbiased, and exact if one light
// dominates.
void chooseLight(Hit hit, Surface surface, Features features, SkyShares sky,
#if GLINT_SIZED_LIGHTS && GLINT_PATHS
                 BsdfSample drawn,
#endif
                 inout ShadeResult result) {
    float random = hostRandom(hit.target, shadingDimension(kDimensionLight));
    uint lights = hostLightCount(hit.position);
    float total = 0.0;
    float chosenWeight = 1.0;
    vec3 chosen = vec3(0.0);
    for (uint i = 0u; i < lights; ++i) {
        HostLight light = lightOfHost(hit, features, i);
        Surface lit = surface;
#if GLINT_SHARED_LIGHTS
        // Both kinds of lights share one evaluation of the BSDF, which is most of the code.
        bool shares = isShared(light);
        vec3 direction;
        float part;
        LightSample aim;
        if (shares) {
            aim = aimAtSharedFromHit(hit, features, light, i, sky, lit, direction, part);
        } else {
            aim = aimAtLight(hit, features, light, lit);
            direction = aim.direction;
#if GLINT_SIZED_LIGHTS
            aim.irradiance *= partOfSample(hit, surface, features, light, direction, sky, lit);
#endif
        }
        vec3 contribution = vec3(0.0);
        if (aim.irradiance != vec3(0.0)) {
            contribution = scatteredLight(lit, features, hit.geometricNormal, direction) * aim.irradiance;
        }
#else
        LightSample aim = aimAtLight(hit, features, light, lit);
        vec3 contribution = unshadowedLight(hit, lit, features, aim);
#endif
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
            result.shadowDirection = aim.direction;
            result.shadowDistance = aim.distance;
#if GLINT_SHARED_LIGHTS
            result.shadowSees = shares ? seenTowardsShared(hit, features, light, aim.direction, part) : kShadowOfLight;
#endif
        } else {
            random = (random - probability) / (1.0 - probability);
        }
    }
#if GLINT_SIZED_LIGHTS && GLINT_PATHS
    uint toFind = lightsInDirection(hit, surface, features, drawn);
    for (uint i = 0u; i < toFind; ++i) {
        LightSample point = foundOnPath(hit, surface, drawn, i);
        float weight = luminance(point.irradiance);
        if (!(weight > 0.0)) {
            continue;
        }
        total += weight;
        float probability = weight / total;
        if (random < probability) {
            random /= probability;
            chosen = point.irradiance;
            chosenWeight = weight;
            result.shadowDirection = point.direction;
            result.shadowDistance = point.distance;
            result.shadowSees = kShadowOfLight;
        } else {
            random = (random - probability) / (1.0 - probability);
        }
    }
#endif
    result.direct = chosen * (total / chosenWeight);
#if GLINT_EFFECT_SHADOW
    // Nothing is between the surface and a light around it.
    if (result.shadowDistance <= 0.0) {
        result.radiance += result.direct;
    }
#endif
}

// The shares of the ambient light where no ray follows the hit. Where shadow rays to the sky pass glass, those of the
// surface that sent the ray have brought a part of what is behind this glass.
SkyShares ambientOfHit(Hit hit, SkyShares sky) {
#if GLINT_SKY_LIGHT && GLINT_SHADOW_GLASS
    sky.transmitted *= storedSkyShare(hit.target);
#endif
    return sky;
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
    result.radiance = countedEmission(hit, surface);
#if GLINT_SIZED_LIGHTS
    // An effect that has traced the transmitted light itself leaves none. The last bounce has a direction, too, which
    // meets lights alone.
    Surface followed = surface;
    followed.bsdf.transmitted *= sky.transmitted;
    BsdfSample drawn = drawDirection(hit, followed, features);
    chooseLight(hit, surface, features, sky, drawn, result);
    if (pathGoesOn()) {
        result.path = nextStep(hit, followed, features, drawn, arrivingShare(hit.arrival, hit.position));
    } else {
        result.radiance += ambientLight(surface, features, hit.view, ambientOfHit(hit, sky));
    }
#else
    chooseLight(hit, surface, features, sky, result);
    if (pathGoesOn()) {
        // An effect that has traced the transmitted light itself leaves none.
        surface.bsdf.transmitted *= sky.transmitted;
        result.path = nextStep(hit, surface, features, arrivingShare(hit.arrival, hit.position));
    } else {
        result.radiance += ambientLight(surface, features, hit.view, ambientOfHit(hit, sky));
    }
#endif
    return result;
}

#else

// Lights a surface that is lit.
ShadeResult shadeSurface(Hit hit, Surface surface, Features features) {
    ShadeResult result = darkness();
    SkyShares sky = wholeSky();
    changeSkyOfHit(hit, features, sky);
    result.radiance = countedEmission(hit, surface) + ambientLight(surface, features, hit.view, ambientOfHit(hit, sky));
    chooseLight(hit, surface, features, sky, result);
    return result;
}

#endif

// Returns the light of the hit by itself, whatever path led to it.
ShadeResult shadeAlone(Hit hit, Features features) {
    Surface surface = evaluateAny(hit, features);
    if (hasLobe(features, GLINT_UNLIT)) {
        ShadeResult result = darkness();
        result.radiance = surface.emission;
        return result;
    }
    return shadeSurface(hit, surface, features);
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
