#include "host/resources.glsl"

struct LightSample {
    vec3 direction;
    float distance;
    vec3 irradiance;
};

#define HostLight LightSample

uint hostLightCount(vec3 position) {
    return glintHostLightCount(position);
}

HostLight hostLight(uint index, vec3 position, vec3 random) {
    GlintLight light = glintHostLight(index, position, random);
    return LightSample(light.direction, light.distance, light.irradiance);
}

LightSample hostSampleLight(HostLight light, vec3 position) {
    return light;
}
