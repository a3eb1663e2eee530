#version 460
// Packs what tells surfaces apart: the normal and the depth, and beside them how fast the depth changes.
#extension GL_GOOGLE_include_directive : require
#include "svgf.glsl"

layout(binding = 0) uniform texture2D depths;
layout(binding = 1) uniform texture2D normals;
layout(binding = 2) uniform texture2D roughness;
layout(binding = 3, rgba32f) uniform writeonly image2D guides;   // mean normal, shorter at borders; depth
layout(binding = 4, rgba32f) uniform writeonly image2D surfaces; // slopes of the depth, metres a pixel; roughness

// The length to which the normal of a pixel at a border is shortened: see edgeDistance().
const float kBorderLength = 0.5;

// The change to the nearer neighbour on an axis.
float slopeOf(ivec2 pixel, ivec2 next, float depth) {
    float before = isInside(pixel - next) ? abs(depth - texelFetch(depths, pixel - next, 0).x) : 1e9;
    float behind = isInside(pixel + next) ? abs(depth - texelFetch(depths, pixel + next, 0).x) : 1e9;
    return min(before, behind);
}

// Whether a neighbour is not on the plane of the pixel, so that samples of both may see both. Their normals may be alike.
bool isBorder(ivec2 pixel, ivec2 next, float depth, float slope) {
    float allowed = 4.0 * slope + 0.02 * depth;
    for (int side = -1; side <= 1; side += 2) {
        ivec2 tap = pixel + side * next;
        if (isInside(tap) && abs(depth - texelFetch(depths, tap, 0).x) > allowed) {
            return true;
        }
    }
    return false;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (isInside(pixel)) {
        float depth = texelFetch(depths, pixel, 0).x;
        vec2 slope = vec2(slopeOf(pixel, ivec2(1, 0), depth), slopeOf(pixel, ivec2(0, 1), depth));
        bool isMixed = isBorder(pixel, ivec2(1, 0), depth, slope.x) || isBorder(pixel, ivec2(0, 1), depth, slope.y);
        vec3 normal = texelFetch(normals, pixel, 0).xyz;
        imageStore(guides, pixel, vec4(isMixed ? kBorderLength * normal : normal, depth));
        imageStore(surfaces, pixel, vec4(slope, texelFetch(roughness, pixel, 0).x, 0.0));
    }
}
