#version 460
// Adds the light of the effects to the lit surfaces, and adds the sample to the running mean.
#include "generated/compose_effects.glsl"
#include "hit/accumulate.glsl"
#include "hit/images.glsl"

layout(local_size_x = kPixelGroupSize, local_size_y = kPixelGroupSize) in;

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy + uvec2(0u, GLINT_FRAME.firstRow);
    if (pixel.x >= GLINT_FRAME.width || pixel.y >= GLINT_FRAME.endRow) {
        return;
    }
    ivec2 place = ivec2(pixel);
    vec3 radiance = imageLoad(radianceImage, place).rgb + composeEffects(pixel.x + pixel.y * GLINT_FRAME.width);
    // A single sample that is not a number would stay in the mean forever.
    if (!isFinite(radiance)) {
        atomicAdd(GLINT_FRAME.counters.data[kCounterNonFinite], 1u);
#if GLINT_TALLIES
        tallyForPixel(pixel.x + pixel.y * GLINT_FRAME.width);
#endif
        GLINT_TALLY_NON_FINITE(any(isnan(radiance)) ? 1u : kInfiniteSample);
        radiance = vec3(0.0);
    }
    RunningMean mean = RunningMean(radiance, vec3(0.0));
    if (GLINT_FRAME.averaged > 0u) {
        RunningMean last = RunningMean(imageLoad(accumulatedImage, place).rgb, imageLoad(residualImage, place).rgb);
        mean = includeSample(last, radiance, GLINT_FRAME.averaged);
    }
    imageStore(accumulatedImage, place, storable(vec4(mean.mean, 1.0)));
    if ((GLINT_FRAME.accumulates & kPictureHasResidual) != 0u) {
        imageStore(residualImage, place, vec4(mean.residual, 0.0));
    }
}
