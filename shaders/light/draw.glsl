// The lights of a surface, each with the point of it that a ray sees. This part needs the hit alone and not its
// material.
#include "light/receiver.glsl"
#include "light/shared.glsl"
#include "light/sized.glsl"
#include "host/lights.glsl"
#include "host/random.glsl"
#if GLINT_PATHS
#include "hit/path.glsl"
#endif

// The dimensions of the random numbers of a sample.
const uint kDimensionLight = 0u;
const uint kDimensionHostLight = 1u;  // and the next two; three more for each further light
// The pairs of the sequence.
const uint kPairLightArea = 5u;
const uint kPairLightChoice = 0x10000u;  // and one more for each further light

// Returns the dimension for the bounce that is being shaded.
uint shadingDimension(uint dimension) {
#if GLINT_PATHS
    return dimensionOfBounce(dimension);
#else
    return dimension;
#endif
}

// A light of the host's list.
HostLight lightOfHost(Hit hit, Features features, uint index) {
#if GLINT_LIGHT_SAMPLES > 0 && !GLINT_EMISSIVE_LIGHTS
    uint drawn = 0u;  // systematic sampling: the samples keep their distance, so none sees the light of another
#else
    uint drawn = index;
#endif
    uint dimension = shadingDimension(kDimensionHostLight + 3u * drawn);
#if GLINT_LIGHT_SAMPLES > 0
    // The first numbers, which decide most, are well distributed.
    vec2 first = hostRandomPair(hit.target, shadingDimension(kPairLightChoice + drawn));
    return hostLight(index, receiverOf(hit, features), vec3(first, hostRandom(hit.target, dimension)));
#else
    vec3 random = vec3(hostRandom(hit.target, dimension), hostRandom(hit.target, dimension + 1u),
                       hostRandom(hit.target, dimension + 2u));
    return hostLight(index, hit.position, random);
#endif
}

struct DrawnLight {
    LightSample aim;  // its shadow ray, and its irradiance without a shadow; the radiance of a shared light
#if GLINT_SHARED_LIGHTS
    vec3 direction;   // unit vector, from which its light comes
    float density;    // of a shared light's sample, 0 if no light arrives; of another light's sample, 0 if no ray of a
                      // lobe finds it
    uint emitter;     // SceneLight::emitter
#endif
};

// Draws the centre of a light, or a point of an area light.
DrawnLight drawPunctual(Hit hit, HostLight light) {
    DrawnLight result;
    result.aim = hostSampleLight(light, hit.position);
#if GLINT_EFFECT_SHADOW
    // All lights may have the same numbers, because only one of them counts.
    if (hostLightHasSize(light)) {
        result.aim = hostSampleLightPoint(light, result.aim, hostRandomPair(hit.target, shadingDimension(kPairLightArea)));
    }
#endif
#if GLINT_SHARED_LIGHTS
    result.direction = result.aim.direction;
    result.density = 0.0;
    result.emitter = kNoEmitter;
#if GLINT_SIZED_LIGHTS
    result.density =
        lobesFind(light) ? lightPointDensity(light, hostSampleLight(light, hit.position), result.direction) : 0.0;
#endif
#endif
    return result;
}

DrawnLight drawLight(Hit hit, Features features, uint index) {
    HostLight light = lightOfHost(hit, features, index);
#if GLINT_SHARED_LIGHTS
    if (isShared(light)) {
        SharedSample drawn = sampleShared(hit, light, index, shadingDimension(0u));
        DrawnLight result;
        result.emitter = light.emitter;
        result.direction = drawn.direction;
        result.density = drawn.density;
        result.aim = LightSample(vec3(0.0), 0.0, vec3(0.0), kRaySent);
        if (drawn.density > 0.0) {
            result.aim = aimAtShared(hit, light, drawn);
            result.aim.irradiance = drawn.radiance;
        }
        return result;
    }
#endif
    return drawPunctual(hit, light);
}

#if defined(GLINT_CHOOSES_CASES) && (GLINT_LIGHT_SAMPLES > 0 || GLINT_SKY_LIGHT)
#define GLINT_DRAWS_FIRST 1

// The threads of a subgroup run one case after the other. Lights that are drawn before the choice are drawn by all
// threads together.
const uint kLightsDrawnFirst = GLINT_LIGHT_SAMPLES + GLINT_SKY_LIGHT;
DrawnLight lightsDrawnFirst[kLightsDrawnFirst];

// Returns the first light that is drawn before the choice. Earlier ones are cheap to draw, but their number varies.
uint firstDrawn() {
#if GLINT_LIGHT_SAMPLES > 0
    return GLINT_FRAME.lightsApart;
#else
    return sceneLightCount();
#endif
}

// `features` are those of the module.
void drawLightsFirst(Hit hit, Features features) {
    uint first = firstDrawn();
    uint end = isLit(features) ? hostLightCount(hit.position) : first;
    for (uint i = first; i < end; ++i) {
        lightsDrawnFirst[i - first] = drawLight(hit, features, i);
    }
}

DrawnLight lightOfSurface(Hit hit, Features features, uint index) {
    uint first = firstDrawn();
    if (index >= first) {
        return lightsDrawnFirst[index - first];
    }
#if GLINT_LIGHT_SAMPLES > 0
    return drawPunctual(hit, lightApart(index));
#else
    return drawLight(hit, features, index);
#endif
}

#else
#define GLINT_DRAWS_FIRST 0

DrawnLight lightOfSurface(Hit hit, Features features, uint index) {
    return drawLight(hit, features, index);
}

#endif
