#version 460
#extension GL_GOOGLE_include_directive : require
// Sends the camera's own rays, so that they must hit what the raster pass saw.
#include "common.glsl"

layout(local_size_x = kPixelGroupSize, local_size_y = kPixelGroupSize) in;

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= FRAME.width || pixel.y >= FRAME.height) {
        return;
    }
    vec2 unit = (vec2(pixel) + 0.5 + FRAME.jitter) / vec2(FRAME.width, FRAME.height);
    vec2 p = vec2(2.0 * unit.x - 1.0, 1.0 - 2.0 * unit.y);
    vec3 across = p.x * FRAME.cameraRight + p.y * FRAME.cameraUp;
    uint target = pixel.x + pixel.y * FRAME.width;
    vec3 origin = FRAME.cameraPosition + (FRAME.orthographic != 0u ? across : vec3(0.0));
    vec3 direction = FRAME.orthographic != 0u ? FRAME.cameraForward : normalize(FRAME.cameraForward + across);
    FRAME.sampleStarts.data[target] = SampleStart(origin, kRaySent);
    FRAME.sampleAims.data[target] = SampleAim(direction, 0.0);
    FRAME.listed.data[atomicAdd(FRAME.counters.data[kCounterRays], 1u)] = target;
}
