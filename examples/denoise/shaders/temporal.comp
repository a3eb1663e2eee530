#version 460
// Adds a frame to the mean of those before it, which motion finds: section 4.1 of the paper.
#extension GL_GOOGLE_include_directive : require
#include "svgf.glsl"

layout(binding = 0) uniform texture2D light;
layout(binding = 1) uniform texture2D motion;
layout(binding = 2) uniform texture2D depths;
layout(binding = 3) uniform texture2D normals;
layout(binding = 4) uniform texture2D lastDepths;
layout(binding = 5) uniform texture2D lastNormals;
layout(binding = 6) uniform texture2D lastLight;    // filtered once
layout(binding = 7) uniform texture2D lastMoments;
layout(binding = 8, rgba32f) uniform writeonly image2D meanLight;
layout(binding = 9, rgba32f) uniform writeonly image2D moments;  // first and second of the luminance, frames

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (!isInside(pixel)) {
        return;
    }
    vec3 value = texelFetch(light, pixel, 0).rgb;
    float depth = texelFetch(depths, pixel, 0).x;
    vec3 normal = unit(texelFetch(normals, pixel, 0).xyz);
    vec3 step = texelFetch(motion, pixel, 0).xyz;
    vec2 last = vec2(pixel) + step.xy;
    ivec2 corner = ivec2(floor(last));
    vec3 sum = vec3(0.0);
    vec3 sumOfMoments = vec3(0.0);
    float weights = 0.0;
    for (int i = 0; i < 4 && isFirst == 0u && depth > 0.0; ++i) {
        ivec2 tap = corner + ivec2(i & 1, i >> 1);
        if (!isInside(tap)) {
            continue;
        }
        float tapDepth = texelFetch(lastDepths, tap, 0).x;
        // A point that a mirror shows has no depth in the frame before. The mirror itself was there.
        float expected = isVirtual != 0u ? depth : depth + step.z;
        bool isSame = tapDepth > 0.0 && abs(tapDepth - expected) < (isVirtual != 0u ? 0.2 : 0.05) * expected &&
                      dot(unit(texelFetch(lastNormals, tap, 0).xyz), normal) > 0.9;
        vec2 near = 1.0 - abs(last - vec2(tap));
        float weight = isSame ? near.x * near.y : 0.0;
        sum += weight * texelFetch(lastLight, tap, 0).rgb;
        sumOfMoments += weight * texelFetch(lastMoments, tap, 0).xyz;
        weights += weight;
    }
    float first = luminance(value);
    vec3 moment = vec3(first, first * first, 1.0);
    if (weights > 0.01) {
        vec3 before = sumOfMoments / weights;
        float frames = before.z + 1.0;
        // The mean of few frames counts all alike; later ones are forgotten at the paper's rate.
        float share = max(alpha, 1.0 / frames);
        value = mix(sum / weights, value, share);
        moment = vec3(mix(before.xy, moment.xy, share), frames);
    }
    imageStore(meanLight, pixel, vec4(value, 0.0));
    imageStore(moments, pixel, vec4(moment, 0.0));
}
