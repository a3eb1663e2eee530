// Lights that a surface may see. The light at a point is the sum over all of them. Here they are the punctual lights of
// Glint's scene, or with --lights K those without bounds and K of the others, which a hierarchy chooses.
//
// A host with many lights may return few: each stands for those that it was chosen from, at random, and its irradiance
// is divided by the probability with which it was chosen. Then the mean of the sum is right, and so is the picture's.
#include "host/resources.glsl"
#include "hit/punctual.glsl"
#if GLINT_LIGHT_SAMPLES > 0
#include "hit/light_tree.glsl"
#endif

// A light. Glint only hands it back to the functions below.
#define HostLight LightRecord

uint hostLightCount(vec3 position) {
#if GLINT_LIGHT_SAMPLES > 0
    return GLINT_FRAME.unboundedLights + (GLINT_FRAME.lightTreeNodes > 0u ? GLINT_LIGHT_SAMPLES : 0u);
#else
    return GLINT_FRAME.lightCount;
#endif
}

// `random` is uniform in [0, 1)³, for hosts that choose. The same arguments give the same light.
HostLight hostLight(uint index, vec3 position, vec3 random) {
#if GLINT_LIGHT_SAMPLES > 0
    if (index < GLINT_FRAME.unboundedLights) {
        uint leaf = GLINT_FRAME.lightTreeNodes + index;
        return GLINT_FRAME.lights.data[GLINT_FRAME.lightNodes.data[leaf].next & ~kLightLeaf];
    }
    // The samples of a surface divide the first random number among them, which spreads them over the tree.
    precise float stratum = (float(index - GLINT_FRAME.unboundedLights) + random.x) / float(GLINT_LIGHT_SAMPLES);
    float probability;
    uint chosen = lightOfTree(position, vec3(min(stratum, kBelowOne), random.yz), probability);
    LightRecord light = GLINT_FRAME.lights.data[chosen];
    light.intensity *= probability > 0.0 ? 1.0 / (float(GLINT_LIGHT_SAMPLES) * probability) : 0.0;
    return light;
#else
    return GLINT_FRAME.lights.data[index];
#endif
}

// The light of the light's centre at a point, without shadows.
LightSample hostSampleLight(HostLight light, vec3 position) {
    return sampleLight(light, position);
}

// Whether shadow rays go to a random point of the light, instead of its centre.
bool hostLightHasSize(HostLight light) {
    return light.size > 0.0;
}

// Samples a point of a light that has a size, by the solid angle that it fills. `centre` comes from hostSampleLight(),
// and u is uniform in [0, 1)². The distance is 0 if the point is within the light.
LightSample hostSampleLightPoint(HostLight light, LightSample centre, vec2 u) {
    return sampleLightArea(light, centre, u);
}
