#version 460
// For random numbers (origin, cone) and directions: the sky's sample, its density, the density that is evaluated for
// it, and that for the direction.
#include "hit/bindings.glsl"
#include "host/sky.glsl"

layout(local_size_x = kRayGroupSize) in;

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= GLINT_FRAME.width) {
        return;
    }
    RayRecord ray = GLINT_FRAME.rays.data[index];
    SkySample drawn = hostSampleSky(ray.origin.xy, vec2(ray.coneWidth, ray.coneSpread));
    uint first = 6u * index;
    GLINT_FRAME.counters.data[first] = floatBitsToUint(drawn.direction.x);
    GLINT_FRAME.counters.data[first + 1u] = floatBitsToUint(drawn.direction.y);
    GLINT_FRAME.counters.data[first + 2u] = floatBitsToUint(drawn.direction.z);
    GLINT_FRAME.counters.data[first + 3u] = floatBitsToUint(drawn.density);
    GLINT_FRAME.counters.data[first + 4u] = floatBitsToUint(hostSkyDensity(drawn.direction));
    GLINT_FRAME.counters.data[first + 5u] = floatBitsToUint(hostSkyDensity(ray.direction));
}
