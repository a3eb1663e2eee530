#version 460
// A hit whose shader ID no case has.
#include "hit/hit_shader.glsl"

void main() {
    atomicAdd(GLINT_FRAME.counters.data[kCounterUnknownShader], 1u);
    ShadeResult result = shadeUnknown();
    shaded.radiance = result.radiance;
    shaded.shadowDistance = 0.0;
}
