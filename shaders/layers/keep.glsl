// Makes the values of layers from the samples of a picture.
#include "hit/accumulate.glsl"
#include "hit/bindings.glsl"

// Returns the mean with one more value.
vec4 meanWith(vec4 last, vec4 value) {
    return last + (value - last) / float(GLINT_FRAME.averaged + 1u);
}

// The variance of all values so far (Welford 1962), without bias, from that of the values before `value`. The means are
// those without and with it.
float varianceWith(float last, float lastMean, float mean, float value) {
    float before = float(GLINT_FRAME.averaged);
    return before > 0.0 ? (last * (before - 1.0) + (value - lastMean) * (value - mean)) / before : 0.0;
}

// Light over an albedo that is the mean of albedos of at least kLeastAlbedo, or 0 where no sample saw a surface.
vec3 demodulated(vec3 light, vec3 albedo) {
    return vec3(albedo.x > 0.0 ? light.x / albedo.x : 0.0, albedo.y > 0.0 ? light.y / albedo.y : 0.0,
                albedo.z > 0.0 ? light.z / albedo.z : 0.0);
}
