// Lights that a surface may see. The light at a point is the sum over all of them. Here they are the punctual lights of
// Glint's scene and, in packages with emissive lights, the triangles that emit light; or, with --lights K, those
// without bounds and K of the others, which a hierarchy chooses. In packages whose sky is a light, it is the last one.
//
// A host with many lights may return few: each stands for those that it was chosen from, at random, and its irradiance
// is divided by the probability with which it was chosen. Then the mean of the sum is right, and so is the picture's.
#include "host/resources.glsl"
#include "light/punctual.glsl"
#include "light/tree.glsl"

// A light. Glint only hands it back to the functions below.
#if GLINT_SHARED_LIGHTS
struct SceneLight {
    LightRecord punctual;
    uint emitter;  // or an emissive triangle (light/emitter.glsl), or kSkyEmitter
    float chance;  // of a triangle, and with --sized-lights of a punctual light, too: how often one of the surface's
                   // samples is expected to fall on it
};
#define HostLight SceneLight
#define GLINT_PUNCTUAL(light) (light).punctual
#else
#define HostLight LightRecord
#define GLINT_PUNCTUAL(light) light
#endif

// The lights apart from the sky.
uint sceneLightCount() {
#if GLINT_LIGHT_SAMPLES > 0
    return GLINT_FRAME.lightsApart + (GLINT_FRAME.lightTreeNodes > 0u ? GLINT_LIGHT_SAMPLES : 0u);
#elif GLINT_EMISSIVE_LIGHTS
    return GLINT_FRAME.lightCount + GLINT_FRAME.emitterCount;
#else
    return GLINT_FRAME.lightCount;
#endif
}

uint hostLightCount(vec3 position) {
#if GLINT_SKY_LIGHT
    return sceneLightCount() + 1u;
#else
    return sceneLightCount();
#endif
}

// A light of the scene by its number.
HostLight lightOfScene(uint number) {
#if GLINT_SIZED_LIGHTS
    return SceneLight(GLINT_FRAME.lights.data[number], kNoEmitter, 1.0);
#elif GLINT_SHARED_LIGHTS
    return SceneLight(GLINT_FRAME.lights.data[number], kNoEmitter, 0.0);
#else
    return GLINT_FRAME.lights.data[number];
#endif
}

#if GLINT_SHARED_LIGHTS

// Returns whether rays of lobes find the light, too: an emissive triangle, or the sky. The functions that sample lights
// are for the others.
bool isShared(HostLight light) {
    return light.emitter != kNoEmitter;
}

#endif

#if GLINT_SKY_LIGHT

HostLight lightOfSky() {
    SceneLight light;
    light.emitter = kSkyEmitter;
    light.chance = 1.0;
    return light;
}

#endif

#if GLINT_EMISSIVE_LIGHTS

// An emissive triangle, of which a surface expects `chance` samples.
HostLight lightOfEmitter(uint emitter, float chance) {
    SceneLight light;
    light.emitter = emitter;
    light.chance = chance;
    return light;
}

// Returns how many samples of an emissive triangle a surface expects to take: SceneLight::chance.
float emitterChance(LightReceiver receiver, uint emitter) {
    uint leaf = GLINT_FRAME.emitters.data[emitter].leaf;
#if GLINT_LIGHT_SAMPLES > 0
    return leaf == kNoEmitter ? 0.0 : lightChance(receiver, leaf);
#else
    return leaf == kNoEmitter ? 0.0 : 1.0;
#endif
}

#endif

#if GLINT_LIGHT_SAMPLES > 0 && GLINT_SIZED_LIGHTS

// SceneLight::chance of the punctual light of a leaf.
float leafChance(LightReceiver receiver, uint leaf) {
    bool isApart = leaf >= GLINT_FRAME.lightTreeNodes;
    return isApart ? 1.0 : lightChance(receiver, leaf);
}

#endif

#if GLINT_LIGHT_SAMPLES > 0

// One of the lights that every surface takes.
HostLight lightApart(uint index) {
    uint leaf = GLINT_FRAME.lightTreeNodes + index;
    return lightOfScene(GLINT_FRAME.lightNodes.data[leaf].next & ~kLightLeaf);
}

// The hierarchy knows the surface that asks. `random` is uniform in [0, 1)³, and the same for all samples of punctual
// lights that a surface takes. The same arguments give the same light.
HostLight hostLight(uint index, LightReceiver receiver, vec3 random) {
#if GLINT_SKY_LIGHT
    if (index == sceneLightCount()) {
        return lightOfSky();
    }
#endif
    if (index < GLINT_FRAME.lightsApart) {
        return lightApart(index);
    }
    precise float place = float(index - GLINT_FRAME.lightsApart) + random.x;
    float chance;
    uint chosen = lightOfTree(receiver, place, random.yz, chance);
#if GLINT_EMISSIVE_LIGHTS
    // If no light reaches the surface, the result is an emitter with the chance 0, because there may be no other light.
    if ((chosen & kLightEmitter) != 0u || chance <= 0.0) {
        return lightOfEmitter(chosen & ~kLightEmitter, chance);
    }
#endif
    HostLight light = lightOfScene(chosen);
    GLINT_PUNCTUAL(light).intensity *= chance > 0.0 ? 1.0 / chance : 0.0;
#if GLINT_SIZED_LIGHTS
    light.chance = chance;
#endif
    return light;
}

#else

// `random` is uniform in [0, 1)³, for hosts that choose. The same arguments give the same light.
HostLight hostLight(uint index, vec3 position, vec3 random) {
#if GLINT_SKY_LIGHT
    if (index == sceneLightCount()) {
        return lightOfSky();
    }
#endif
#if GLINT_EMISSIVE_LIGHTS
    if (index >= GLINT_FRAME.lightCount) {
        uint emitter = index - GLINT_FRAME.lightCount;
        return lightOfEmitter(emitter, emitterChance(LightReceiver(position, vec3(0.0)), emitter));
    }
#endif
    return lightOfScene(index);
}

#endif

// The light of the light's centre at a point, without shadows.
LightSample hostSampleLight(HostLight light, vec3 position) {
    return sampleLight(GLINT_PUNCTUAL(light), position);
}

// Returns whether the light has a size. Its light then comes from random points of it, instead of its centre.
bool hostLightHasSize(HostLight light) {
    return GLINT_PUNCTUAL(light).size > 0.0;
}

// Samples a point of an area light, by the solid angle that it fills. `centre` comes from hostSampleLight(), and u is
// uniform in [0, 1)². The irradiance is that of a surface that faces the point, if all of the light were there. The
// distance is 0 if the surface is within the light.
LightSample hostSampleLightPoint(HostLight light, LightSample centre, vec2 u) {
    return sampleLightArea(GLINT_PUNCTUAL(light), centre, u);
}
