#version 460
// A hit whose shader ID no case has.
#include "strategies/hit_shaders/hit_shader.glsl"

void main() {
    atomicAdd(GLINT_FRAME.counters.data[kCounterUnknownShader], 1u);
#if GLINT_ANSWERS_SURFACE
    storeSurface(floatBitsToUint(shaded.radiance.x), shadeUnknown().surface);
#else
#if GLINT_PATHS
    uint target = floatBitsToUint(shaded.radiance.x);
#endif
    shaded.radiance = shadeUnknown().radiance;
#if GLINT_PATHS
    uint place = samplePlace(target);
    shaded.radiance *= pathSoFar(place).throughput;
    endPath(place);
#endif
#endif
    shaded.shadowDistance = 0.0;
}
