#version 460
// One pass of the edge-avoiding wavelet: section 4.3 of the paper.
#extension GL_GOOGLE_include_directive : require
#include "svgf.glsl"

layout(binding = 0) uniform texture2D light;  // with variance
layout(binding = 1) uniform texture2D depths;
layout(binding = 2) uniform texture2D normals;
layout(binding = 3, rgba32f) uniform writeonly image2D result;

const float kKernel[3] = float[3](3.0 / 8.0, 1.0 / 4.0, 1.0 / 16.0);

// The variance over 3 x 3 pixels, which alone would be noisy (equation 5).
float smoothVariance(ivec2 pixel) {
    float sum = 0.0;
    float weights = 0.0;
    for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
            if (isInside(pixel + ivec2(x, y))) {
                float weight = (x == 0 ? 0.5 : 0.25) * (y == 0 ? 0.5 : 0.25);
                sum += weight * texelFetch(light, pixel + ivec2(x, y), 0).w;
                weights += weight;
            }
        }
    }
    return sum / weights;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (!isInside(pixel)) {
        return;
    }
    vec4 centre = texelFetch(light, pixel, 0);
    float depth = texelFetch(depths, pixel, 0).x;
    if (depth <= 0.0) {
        imageStore(result, pixel, centre);
        return;
    }
    vec3 normal = unit(texelFetch(normals, pixel, 0).xyz);
    vec2 slope = depthSlope(depths, pixel, depth);
    float deviation = kSigmaLight * sqrt(max(smoothVariance(pixel), 0.0)) + 1e-6;
    vec3 sum = kKernel[0] * kKernel[0] * centre.rgb;
    float variance = pow(kKernel[0], 4.0) * centre.w;
    float weights = kKernel[0] * kKernel[0];
    for (int y = -2; y <= 2; ++y) {
        for (int x = -2; x <= 2; ++x) {
            ivec2 tap = pixel + stride * ivec2(x, y);
            if ((x == 0 && y == 0) || !isInside(tap)) {
                continue;
            }
            vec4 other = texelFetch(light, tap, 0);
            float weight = kKernel[abs(x)] * kKernel[abs(y)] *
                           edgeWeight(depth, texelFetch(depths, tap, 0).x, slope, float(stride) * vec2(x, y), normal,
                                      unit(texelFetch(normals, tap, 0).xyz)) *
                           exp(-abs(luminance(other.rgb) - luminance(centre.rgb)) / deviation);
            sum += weight * other.rgb;
            variance += weight * weight * other.w;
            weights += weight;
        }
    }
    imageStore(result, pixel, vec4(sum / weights, variance / (weights * weights)));
}
