#version 460
#extension GL_GOOGLE_include_directive : require
// Computes the running mean of what the raster pass saw, what the ray saw, the texel, and the ray's distance.
#include "common.glsl"
#include "images.glsl"

layout(local_size_x = kPixelGroupSize, local_size_y = kPixelGroupSize) in;

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= FRAME.width || pixel.y >= FRAME.height) {
        return;
    }
    ivec2 place = ivec2(pixel);
    vec4 radiance = imageLoad(radianceImage, place);
    vec3 reflection = FRAME.sampleStarts.data[pixel.x + pixel.y * FRAME.width].origin_orRadiance;
    vec4 value = vec4(radiance.x, reflection.x, radiance.z, reflection.z);
    vec4 mean = value;
    if (FRAME.sampleIndex > 0u) {
        vec4 before = imageLoad(accumulatedImage, place);
        mean = before + (value - before) / float(FRAME.sampleIndex + 1u);
    }
    imageStore(accumulatedImage, place, mean);
}
