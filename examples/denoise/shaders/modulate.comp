#version 460
// Multiplies a filtered light by its albedo, and adds it to the picture, which begins with the emission.
#extension GL_GOOGLE_include_directive : require
#include "svgf.glsl"

layout(binding = 0) uniform texture2DArray lights;
layout(binding = 1) uniform texture2D albedo;
layout(binding = 2) uniform texture2D emission;
layout(binding = 3, rgba32f) uniform image2D picture;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (isInside(pixel)) {
        vec3 before = isFirst != 0u ? texelFetch(emission, pixel, 0).rgb : imageLoad(picture, pixel).rgb;
        vec3 own = texelFetch(lights, ivec3(pixel, signal), 0).rgb * texelFetch(albedo, pixel, 0).rgb;
        imageStore(picture, pixel, vec4(before + own, 1.0));
    }
}
