#version 460
// Applies directionOr() to each ray's direction; the fallback is (2, 2, 2).
#include "hit/bindings.glsl"
#include "hit/geometry.glsl"

layout(local_size_x = kRayGroupSize) in;

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= GLINT_FRAME.width) {
        return;
    }
    vec3 unit = directionOr(GLINT_FRAME.rays.data[index].direction, vec3(2.0));
    for (uint i = 0u; i < 3u; ++i) {
        GLINT_FRAME.counters.data[3u * index + i] = floatBitsToUint(unit[i]);
    }
}
