// shade(): the one function that every strategy calls for a hit. Here it answers with the light that comes back.
#include "effects/ambient.glsl"
#include "generated/hit_effects.glsl"
#include "hit/answer_radiance.glsl"
#include "light/draw.glsl"
#include "hit/material.glsl"
#include "light/sized.glsl"
#if GLINT_PATHS
#include "hit/path_sample.glsl"
#endif

// The light of one light on a surface, without its shadow.
vec3 unshadowedLight(Hit hit, Surface surface, Features features, LightSample light) {
    return scatteredLight(surface, features, hit.geometricNormal, light.direction) * light.irradiance;
}

#if GLINT_SHARED_LIGHTS

// Returns whether a ray of the path follows from the hit. It finds shared lights, too.
bool sendsRay() {
#if GLINT_PATHS
    return pathGoesOn();
#else
    return false;
#endif
}

// Leaves the lobes on which samples of the light bring its light. `sky` is the share that no ray of an effect brings.
void keepSampledLobes(Hit hit, Features features, uint emitter, SkyShares sky, inout Surface surface) {
    // An effect that follows the transmitted light finds shared lights itself.
    surface.bsdf.base.transmitted *= sky.transmitted;
#if GLINT_SKY_LIGHT
    if (emitter == kSkyEmitter) {
        if (!sendsRay()) {
            keepShares(features, sampledShares(surface, features, wholeSky(), wholeSky()), surface);
        }
#if GLINT_SHADOW_GLASS
        surface.bsdf.base.transmitted = vec3(0.0);
#endif
    }
#endif
#if GLINT_EMISSIVE_LIGHTS && GLINT_SHADOW_GLASS
    surface.bsdf.base.transmitted = vec3(0.0);
#endif
}

// The irradiance of a sample of a shared light at the hit of a ray, without its shadow, on the lobes that `lit` keeps.
// Where no ray follows, this sample counts alone. `part` is the share of its light that it counts for.
vec3 irradianceOfShared(Hit hit, Features features, DrawnLight light, SkyShares sky, inout Surface lit,
                        out float part) {
    part = 1.0;
    if (light.density <= 0.0) {
        return vec3(0.0);
    }
#if GLINT_EMISSIVE_LIGHTS && GLINT_SHADOW_GLASS
    if (isWithinGlass(hit, features)) {
        return vec3(0.0);
    }
#elif GLINT_SKY_LIGHT && GLINT_SHADOW_GLASS
    if (light.emitter == kSkyEmitter && isWithinGlass(hit, features)) {
        return vec3(0.0);
    }
#endif
    float density = light.density;
#if GLINT_PATHS
    if (pathGoesOn()) {
        Surface whole = lit;
        whole.bsdf.base.transmitted *= sky.transmitted;
        density += bsdfPdf(whole.bsdf, features, toSurface(lit, light.direction));
    }
#endif
    part = light.density / density;
    keepSampledLobes(hit, features, light.emitter, sky, lit);
    return light.aim.distance > 0.0 ? light.aim.irradiance / density : vec3(0.0);
}

// Returns the surfaces that its shadow ray sees: as for a ray of the path, or as for rays to other lights.
uint seenTowardsShared(Hit hit, Features features, uint emitter, vec3 direction, float part) {
    if (passesAsLight(emitter)) {
        return kShadowOfLight;
    }
#if GLINT_EMISSIVE_LIGHTS && GLINT_SHADOW_GLASS
    return (floatBitsToUint(1.0 / part) & ~kShadowKind) | kShadowPastGlass;
#elif GLINT_PATHS
    bool passes = dot(direction, hit.geometricNormal) < 0.0;
    return !isWithin(mediaOfStep(hit, features, passes)) ? kShadowOfShared : kShadowOfSharedWithin;
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

// The irradiance of another light. Where shadow rays pass glass, the surface that sent the ray has had the light of
// such lights behind this glass on the straight line, with all that happens within the glass, and this light would
// count twice.
vec3 irradianceOf(Hit hit, Features features, DrawnLight light, inout Surface lit) {
#if GLINT_SHADOW_GLASS
    if (passesFacets(features)) {
        lit.bsdf.base.transmitted = vec3(0.0);
        if (isWithinGlass(hit, features)) {
            return vec3(0.0);
        }
    }
#endif
    return light.aim.irradiance;
}

#if GLINT_SIZED_LIGHTS && GLINT_PATHS

// Returns whether samples alone bring the light from a side of the surface: with --shadow-through glass, the light
// through glass that the surface which sent the ray has sampled (irradianceOf()).
bool isSampledAlone(Hit hit, Features features, bool passes) {
#if GLINT_SHADOW_GLASS
    return passesFacets(features) && (passes || isWithinGlass(hit, features));
#else
    return false;
#endif
}

#endif

#if GLINT_SIZED_LIGHTS

// The part of its light that the sample of a light counts for, on the lobes that `lit` keeps. The direction of the path
// brings the rest, and the walk of a refracted ray has found the light through the surface at which it ended.
float partOfSample(Hit hit, Surface surface, Features features, DrawnLight light, SkyShares sky, inout Surface lit) {
    if (light.density <= 0.0) {
        return 1.0;
    }
    lit.bsdf.base.transmitted *= sky.transmitted;
#if GLINT_PATHS
    if (!isSampledAlone(hit, features, dot(light.direction, hit.geometricNormal) < 0.0)) {
        surface.bsdf.base.transmitted *= sky.transmitted;
        return light.density /
               (light.density + bsdfPdf(surface.bsdf, features, toSurface(surface, light.direction)));
    }
#endif
    return 1.0;
}

#endif

#if GLINT_SIZED_LIGHTS && GLINT_PATHS

// The lights to look for in the direction of the path. A direction that the triangle's plane turns is none of the lobe's.
LightSearch lightsInDirection(Hit hit, Surface surface, Features features, BsdfSample drawn) {
    bool passes = drawn.direction.z < 0.0 && transmits(features);
    float height = dot(toWorld(surface, drawn.direction), hit.geometricNormal) * (passes ? -1.0 : 1.0);
    bool looks = drawn.pdf > 0.0 && height > 0.0 && !isSampledAlone(hit, features, passes);
    return lightsOnRay(hit.position, toWorld(surface, drawn.direction), 2.0 * kFarDistance, looks);
}

// The point of a light that the direction meets, with the light that it brings to the viewer; black if it meets none.
LightSample foundOnPath(Hit hit, Surface surface, Features features, BsdfSample drawn, uint number) {
    HostLight light = lightToFind(number);
    LightSample centre = hostSampleLight(light, hit.position);
    LightSample point = lightAlong(light, centre, toWorld(surface, drawn.direction));
#if GLINT_LIGHT_SAMPLES > 0
    if (point.irradiance == vec3(0.0)) {
        return point;
    }
    light.chance = leafChance(receiverOf(hit, features), number);
#endif
    float part = lobesFind(light) ? drawn.pdf / (drawn.pdf + lightPointDensity(light, centre, point.direction)) : 0.0;
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
    vec3 whole = vec3(0.0);
    vec3 chosen = vec3(0.0);  // light with the weight 1
    for (uint i = 0u; i < lights; ++i) {
        DrawnLight light = lightOfSurface(hit, features, i);
        Surface lit = surfaceAgain(surface, features, i);
#if GLINT_SHARED_LIGHTS
        // All kinds of lights share one evaluation of the BSDF, which is most of the code.
        bool shares = light.emitter != kNoEmitter;
        float part;
        vec3 irradiance = shares ? irradianceOfShared(hit, features, light, sky, lit, part)
                                 : irradianceOf(hit, features, light, lit);
#if GLINT_SIZED_LIGHTS
        if (!shares) {
            irradiance *= partOfSample(hit, surface, features, light, sky, lit);
        }
#endif
        vec3 contribution = vec3(0.0);
        if (irradiance != vec3(0.0)) {
            contribution = scatteredLight(lit, features, hit.geometricNormal, light.direction) * irradiance;
        }
#else
        vec3 irradiance = irradianceOf(hit, features, light, lit);
        vec3 contribution = scatteredLight(lit, features, hit.geometricNormal, light.aim.direction) * irradiance;
#endif
        float weight = luminance(contribution);
        if (weight <= 0.0) {
            continue;
        }
        total += weight;
        whole += contribution;
        float probability = weight / total;
        if (random < probability) {
            random /= probability;
            chosen = contribution / weight;
            result.shadowDirection = light.aim.direction;
            result.shadowDistance = light.aim.distance;
#if GLINT_SHARED_LIGHTS
            result.shadowSees =
                shares ? seenTowardsShared(hit, features, light.emitter, light.aim.direction, part) : kShadowOfLight;
#endif
        } else {
            random = (random - probability) / (1.0 - probability);
        }
    }
#if GLINT_SIZED_LIGHTS && GLINT_PATHS
    LightSearch toFind = lightsInDirection(hit, surface, features, drawn);
    GLINT_EACH_LIGHT(i, toFind) {
        LightSample point = foundOnPath(hit, surface, features, drawn, i);
        float weight = luminance(point.irradiance);
        if (!(weight > 0.0)) {
            continue;
        }
        total += weight;
        whole += point.irradiance;
        float probability = weight / total;
        if (random < probability) {
            random /= probability;
            chosen = point.irradiance / weight;
            result.shadowDirection = point.direction;
            result.shadowDistance = point.distance;
            result.shadowSees = kShadowOfLight;
        } else {
            random = (random - probability) / (1.0 - probability);
        }
    }
#endif
    result.direct = chosen * total;
#if GLINT_SHADES_ALL
    // The chosen light stands for all of them, so its shadow is that of the whole.
    if (total > 0.0 && shadesAll(features)) {
        result.direct = shadeAll(surface.bsdf.layers, features, surface.bsdf.view, whole);
    }
#endif
#if GLINT_EFFECT_SHADOW
    // Nothing is between the surface and a light around it.
    if (result.shadowDistance <= 0.0) {
        result.radiance += result.direct;
    }
#endif
}

// The shares of the ambient light where no ray follows the hit. Where shadow rays to the sky pass glass, those of the
// surface that sent the ray have brought a part of the light behind this glass.
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
    followed.bsdf.base.transmitted *= sky.transmitted;
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
        surface.bsdf.base.transmitted *= sky.transmitted;
        BsdfSample drawn = drawDirection(hit, surface, features);
        result.path = nextStep(hit, surface, features, drawn, arrivingShare(hit.arrival, hit.position));
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
    if (!isLit(features)) {
        ShadeResult result = darkness();
        result.radiance = surface.emission;
        return result;
    }
    return shadeSurface(hit, surface, features);
}

#if GLINT_PATHS

// Returns the part of that light that arrives at the primary surface.
ShadeResult shade(Hit hit, Features features) {
    vec3 arriving = arrivingShare(hit.arrival, hit.position);
    if (isWithin(hit.arrival.media) && !hit.frontFace && !showsBack(features)) {
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
