#include "host/resources.glsl"

vec3 hostSky(vec3 direction) {
    return glintHostSky(direction);
}

vec3 hostSkyAround(vec3 direction, float roughness) {
    return glintHostSkyAround(direction, roughness);
}

vec3 hostSkyIrradianceOverPi(vec3 normal) {
    return glintHostSkyIrradianceOverPi(normal);
}
