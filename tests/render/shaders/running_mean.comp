#version 460
// Computes the running mean of `sampleIndex` samples of three kinds, one in each channel.
#include "hit/accumulate.glsl"
#include "hit/bindings.glsl"
#include "hit/random.glsl"

layout(local_size_x = kRayGroupSize) in;

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= GLINT_FRAME.width) {
        return;
    }
    RunningMean mean = RunningMean(vec3(0.0), vec3(0.0));
    for (uint i = 0u; i < GLINT_FRAME.sampleIndex; ++i) {
        float random = randomUnit(index, i, GLINT_FRAME.seed, 0u);
        // The kinds are: anything; nearly always the same; rarely very bright. No operation rounds except the
        // second's sum.
        vec3 value = vec3(random, 1.0 + random / 512.0, random < 1.0 / 1024.0 ? 4096.0 : 0.5);
        mean = i > 0u ? includeSample(mean, value, i) : RunningMean(value, vec3(0.0));
    }
    for (uint i = 0u; i < 3u; ++i) {
        GLINT_FRAME.counters.data[3u * index + i] = floatBitsToUint(mean.mean[i]);
    }
}
