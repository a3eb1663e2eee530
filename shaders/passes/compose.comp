#version 460
// Adds the reflection to the lit surfaces and takes the sample into the running mean.
#include "hit/images.glsl"

layout(local_size_x = kPixelGroupSize, local_size_y = kPixelGroupSize) in;

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= GLINT_FRAME.width || pixel.y >= GLINT_FRAME.height) {
        return;
    }
    ivec2 place = ivec2(pixel);
    vec3 radiance = imageLoad(radianceImage, place).rgb +
                    imageLoad(reflectanceImage, place).rgb * imageLoad(reflectionImage, place).rgb;
    vec3 mean = radiance;
    if (GLINT_FRAME.sampleIndex > 0u) {
        vec3 before = imageLoad(accumulatedImage, place).rgb;
        mean = before + (radiance - before) / float(GLINT_FRAME.sampleIndex + 1u);
    }
    imageStore(accumulatedImage, place, vec4(mean, 1.0));
}
