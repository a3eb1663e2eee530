// The samples of effects in memory: what primary surfaces send, and the light that comes back.
#include "hit/bindings.glsl"
#if GLINT_PATHS
#include "hit/path.glsl"
#endif

uint pixelCount() {
    return GLINT_FRAME.width * GLINT_FRAME.height;
}

// Returns the number of a pixel's sample.
uint sampleTarget(uint slot, uint pixel) {
    return slot * pixelCount() + pixel;
}

EffectSample noSample(uint outcome) {
    return EffectSample(vec3(0.0), outcome, vec3(0.0), 0.0, vec3(0.0), 0.0);
}

void storeSample(uint target, EffectSample drawn) {
    GLINT_FRAME.samples.data[target] = drawn;
    GLINT_FRAME.radiance.data[target] = vec4(0.0, 0.0, 0.0, float(kPathNone));
#if GLINT_PATHS
    beginPath(target);
#endif
}

#if GLINT_EMISSIVE_LIGHTS
// How the ray of a sample was chosen, for what it finds on emissive lights.
void storeLobeRay(uint target, float density, uint normal) {
    GLINT_FRAME.lobeRays.data[target] = LobeRay(density, normal);
}
#endif

// path is one of kPath*. It is that of the first bounce; further bounces add their light.
void storeRadiance(uint target, vec3 radiance, uint path) {
#if GLINT_PATHS
    if (GLINT_FRAME.bounce > 1u) {
        // A sample has one ray at a time, so no other thread writes here.
        GLINT_FRAME.radiance.data[target].rgb += radiance;
        return;
    }
#endif
    GLINT_FRAME.radiance.data[target] = vec4(radiance, float(path));
}
