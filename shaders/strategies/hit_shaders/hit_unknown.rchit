#version 460
// A hit whose shader ID no case has.
#include "strategies/hit_shaders/hit_shader.glsl"

void main() {
    atomicAdd(GLINT_FRAME.counters.data[kCounterUnknownShader], 1u);
#if GLINT_ANSWERS_SURFACE
    storeSurface(floatBitsToUint(shaded.radiance.x), shadeUnknown().surface);
#else
    shaded.radiance = shadeUnknown().radiance;
#endif
    shaded.shadowDistance = 0.0;
}
