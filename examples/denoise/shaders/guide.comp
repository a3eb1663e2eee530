#version 460
// Packs what tells surfaces apart: the normal and the depth, and beside them how fast the depth changes.
#extension GL_GOOGLE_include_directive : require
#include "svgf.glsl"

layout(binding = 0) uniform texture2D depths;
layout(binding = 1) uniform texture2D normals;
layout(binding = 2) uniform texture2D roughness;
layout(binding = 3, rgba32f) uniform writeonly image2D guides;   // mean normal, depth
layout(binding = 4, rgba32f) uniform writeonly image2D surfaces; // slopes of the depth, metres a pixel; roughness

// The change to the nearer neighbour on an axis.
float slopeOf(ivec2 pixel, ivec2 next, float depth) {
    float before = isInside(pixel - next) ? abs(depth - texelFetch(depths, pixel - next, 0).x) : 1e9;
    float behind = isInside(pixel + next) ? abs(depth - texelFetch(depths, pixel + next, 0).x) : 1e9;
    return min(before, behind);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (isInside(pixel)) {
        float depth = texelFetch(depths, pixel, 0).x;
        imageStore(guides, pixel, vec4(texelFetch(normals, pixel, 0).xyz, depth));
        imageStore(surfaces, pixel,
                   vec4(slopeOf(pixel, ivec2(1, 0), depth), slopeOf(pixel, ivec2(0, 1), depth),
                        texelFetch(roughness, pixel, 0).x, 0.0));
    }
}
