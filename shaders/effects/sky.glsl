// The sky: radiance linear in the cosine from horizon to zenith above, and to the ground below.
#include "hit/bindings.glsl"

vec3 skyRadiance(vec3 direction) {
    vec3 pole = direction.y >= 0.0 ? GLINT_FRAME.skyZenith : GLINT_FRAME.skyGround;
    return mix(GLINT_FRAME.skyHorizon, pole, min(abs(direction.y), 1.0));
}

// Irradiance over π, by the first two orders of spherical harmonics (Ramamoorthi and Hanrahan 2001): the mean of the
// radiance and 2/3 of its first moment, both exact for this sky.
vec3 skyIrradianceOverPi(vec3 normal) {
    vec3 mean = 0.25 * (2.0 * GLINT_FRAME.skyHorizon + GLINT_FRAME.skyZenith + GLINT_FRAME.skyGround);
    vec3 slope = 0.5 * (GLINT_FRAME.skyZenith - GLINT_FRAME.skyGround);
    return mean + (2.0 / 3.0) * slope * normal.y;
}
