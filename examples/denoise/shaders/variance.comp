#version 460
// Estimates the variance of the luminance: over time, or over the pixels around where few frames are known (section
// 4.2 of the paper). A frame of several samples has a variance of its own, which says where there is no noise to
// remove; the paper, with one sample, has to guess it from the pixels around.
#extension GL_GOOGLE_include_directive : require
#include "svgf.glsl"

layout(binding = 0) uniform texture2D light;
layout(binding = 1) uniform texture2D moments;
layout(binding = 2) uniform texture2D depths;
layout(binding = 3) uniform texture2D normals;
layout(binding = 4) uniform texture2D sampled;  // variance of the luminance of samples, not demodulated
layout(binding = 5) uniform texture2D albedo;
layout(binding = 6, rgba32f) uniform writeonly image2D result;  // light, variance

// The variance of this frame's mean, demodulated.
float varianceOfFrame(ivec2 pixel) {
    float scale = max(luminance(texelFetch(albedo, pixel, 0).rgb), 1e-4);
    return texelFetch(sampled, pixel, 0).x / (scale * scale * float(samples));
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (!isInside(pixel)) {
        return;
    }
    vec3 value = texelFetch(light, pixel, 0).rgb;
    vec3 moment = texelFetch(moments, pixel, 0).xyz;
    float depth = texelFetch(depths, pixel, 0).x;
    if (depth <= 0.0) {
        imageStore(result, pixel, vec4(value, 0.0));
        return;
    }
    float frames = max(moment.z, 1.0);
    float variance = max(moment.y - moment.x * moment.x, 0.0);
    if (frames < 4.0 && samples > 1u) {
        // Few samples know their variance badly: it is smoothed over the surface.
        vec3 normal = unit(texelFetch(normals, pixel, 0).xyz);
        vec2 slope = depthSlope(depths, pixel, depth);
        variance = varianceOfFrame(pixel);
        float weights = 1.0;
        for (int i = 0; i < 9; ++i) {
            ivec2 tap = pixel + ivec2(i % 3, i / 3) - 1;
            if (i == 4 || !isInside(tap)) {
                continue;
            }
            float weight = edgeWeight(depth, texelFetch(depths, tap, 0).x, slope, vec2(tap - pixel), normal,
                                      unit(texelFetch(normals, tap, 0).xyz));
            variance += weight * varianceOfFrame(tap);
            weights += weight;
        }
        variance /= weights * frames;
    } else if (frames < 4.0) {
        vec3 normal = unit(texelFetch(normals, pixel, 0).xyz);
        vec2 slope = depthSlope(depths, pixel, depth);
        vec3 sum = value;
        vec2 sums = moment.xy;
        float weights = 1.0;
        for (int y = -3; y <= 3; ++y) {
            for (int x = -3; x <= 3; ++x) {
                ivec2 tap = pixel + ivec2(x, y);
                if ((x == 0 && y == 0) || !isInside(tap)) {
                    continue;
                }
                float weight = edgeWeight(depth, texelFetch(depths, tap, 0).x, slope, vec2(x, y), normal,
                                          unit(texelFetch(normals, tap, 0).xyz));
                sum += weight * texelFetch(light, tap, 0).rgb;
                sums += weight * texelFetch(moments, tap, 0).xy;
                weights += weight;
            }
        }
        value = sum / weights;
        sums /= weights;
        variance = max(sums.y - sums.x * sums.x, 0.0) * 4.0 / frames;
    }
    imageStore(result, pixel, vec4(value, variance));
}
