// The sky's radiance. Here it is an environment map, or a gradient that is linear in the cosine: from horizon to zenith
// above, and from horizon to ground below. Directions are unit vectors of the world.
#include "bsdf/constants.glsl"
#include "host/resources.glsl"

#if GLINT_ENVIRONMENT_MAP

// An equirectangular map. Each level holds the means over the lobes of one roughness.
layout(set = GLINT_BINDING_ENVIRONMENT_SET, binding = GLINT_BINDING_ENVIRONMENT) uniform sampler2D environmentMap;

// v is the polar angle from +Y; u is the azimuth from +X towards +Z, with +X at the middle of the map. Both come from
// atan, which keeps its digits at the poles.
vec2 environmentCoordinates(vec3 direction) {
    // At a pole any azimuth is right, and atan(0, 0) is undefined.
    float across = length(direction.xz);
    float azimuth = across > 0.0 ? atan(direction.z, direction.x) : 0.0;
    return vec2(azimuth / (2.0 * kPi) + 0.5 + GLINT_FRAME.environmentTurn, atan(across, direction.y) / kPi);
}

// The light that a lobe of this roughness about the direction sees. An explicit level avoids a seam where u jumps.
vec3 hostSkyAround(vec3 direction, float roughness) {
    float level = roughness * (GLINT_FRAME.environmentLevels - 1.0);
    return textureLod(environmentMap, environmentCoordinates(direction), level).rgb * GLINT_FRAME.environmentScale;
}

vec3 hostSky(vec3 direction) {
    return hostSkyAround(direction, 0.0);
}

// Irradiance over π from nine spherical harmonics. With a small bright sun they are negative where there is hardly any
// light.
vec3 hostSkyIrradianceOverPi(vec3 n) {
    vec3 sum = GLINT_FRAME.skyHarmonics[0] + GLINT_FRAME.skyHarmonics[1] * n.x + GLINT_FRAME.skyHarmonics[2] * n.y +
               GLINT_FRAME.skyHarmonics[3] * n.z + GLINT_FRAME.skyHarmonics[4] * (3.0 * n.y * n.y - 1.0) +
               GLINT_FRAME.skyHarmonics[5] * (n.x * n.y) + GLINT_FRAME.skyHarmonics[6] * (n.y * n.z) +
               GLINT_FRAME.skyHarmonics[7] * (n.x * n.z) + GLINT_FRAME.skyHarmonics[8] * (n.x * n.x - n.z * n.z);
    return max(sum, vec3(0.0));
}

#else

vec3 hostSky(vec3 direction) {
    vec3 pole = direction.y >= 0.0 ? GLINT_FRAME.skyZenith : GLINT_FRAME.skyGround;
    return mix(GLINT_FRAME.skyHorizon, pole, min(abs(direction.y), 1.0));
}

// Irradiance over π from the first two orders of spherical harmonics (Ramamoorthi and Hanrahan 2001): the mean of the
// radiance plus 2/3 of its first moment. Both are exact for this sky.
vec3 hostSkyIrradianceOverPi(vec3 normal) {
    vec3 mean = 0.25 * (2.0 * GLINT_FRAME.skyHorizon + GLINT_FRAME.skyZenith + GLINT_FRAME.skyGround);
    vec3 slope = 0.5 * (GLINT_FRAME.skyZenith - GLINT_FRAME.skyGround);
    return mean + (2.0 / 3.0) * slope * normal.y;
}

// The sky in one direction. A rough lobe sees the sky's mean around it.
vec3 hostSkyAround(vec3 direction, float roughness) {
    return mix(hostSky(direction), hostSkyIrradianceOverPi(direction), roughness);
}

#endif
