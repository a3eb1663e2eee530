#version 460
// Adds the picture to those before it, which gives edges of surfaces and textures the samples of several frames: the
// last pass of the paper (Karis, "High Quality Temporal Supersampling", SIGGRAPH 2014 courses).
#extension GL_GOOGLE_include_directive : require
#include "svgf.glsl"

layout(binding = 0) uniform texture2D picture;
layout(binding = 1) uniform texture2D lastResult;
layout(binding = 2) uniform texture2D motion;
layout(binding = 3) uniform texture2D guides;
layout(binding = 4, rgba32f) uniform writeonly image2D result; // light, frames

// The history may be this many deviations from the neighbourhood of a pixel.
const float kReach = 1.25;
// Least weight of a new frame where things move by a pixel or more.
const float kMovingShare = 0.15;

// Weight of a pixel at a distance of at most 2 pixels on an axis (Catmull and Rom 1974).
float catmullRom(float x) {
    return x < 1.0 ? 1.0 + x * x * (1.5 * x - 2.5) : 2.0 + x * (-4.0 + x * (2.5 - 0.5 * x));
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (!isInside(pixel)) {
        return;
    }
    vec3 value = texelFetch(picture, pixel, 0).rgb;
    vec3 sum = vec3(0.0);
    vec3 squares = vec3(0.0);
    float count = 0.0;
    // An edge moves with the surface that is nearest.
    ivec2 nearest = pixel;
    float nearestDepth = 1e9;
    for (int i = 0; i < 9; ++i) {
        ivec2 tap = pixel + ivec2(i % 3, i / 3) - 1;
        if (!isInside(tap)) {
            continue;
        }
        vec3 other = texelFetch(picture, tap, 0).rgb;
        sum += other;
        squares += other * other;
        count += 1.0;
        float depth = texelFetch(guides, tap, 0).w;
        if (depth > 0.0 && depth < nearestDepth) {
            nearest = tap;
            nearestDepth = depth;
        }
    }
    vec3 mean = sum / count;
    vec3 deviation = kReach * sqrt(max(squares / count - mean * mean, vec3(0.0)));
    vec2 last = vec2(pixel) + texelFetch(motion, nearest, 0).xy;
    ivec2 corner = ivec2(floor(last));
    vec4 before = vec4(0.0);
    float weights = 0.0;
    // Linear interpolation would blur the picture again in each frame.
    for (int i = 0; i < 16 && isFirst == 0u; ++i) {
        ivec2 tap = corner + ivec2(i & 3, i >> 2) - 1;
        if (isInside(tap)) {
            vec2 away = abs(last - vec2(tap));
            float weight = catmullRom(away.x) * catmullRom(away.y);
            before += weight * texelFetch(lastResult, tap, 0);
            weights += weight;
        }
    }
    float frames = 1.0;
    if (weights > 0.5) {
        before /= weights;
        frames = max(before.w, 0.0) + 1.0;
        float share = max(shareOf(frames), kMovingShare * min(distance(last, vec2(pixel)), 1.0));
        value = mix(clamp(before.rgb, max(mean - deviation, vec3(0.0)), mean + deviation), value, share);
    }
    imageStore(result, pixel, vec4(value, frames));
}
