#version 460
// One pass of the edge-avoiding wavelet: section 4.3 of the paper.
#extension GL_GOOGLE_include_directive : require
#include "svgf.glsl"

layout(binding = 0) uniform texture2DArray lights; // with variance
layout(binding = 1) uniform texture2D guides;
layout(binding = 2) uniform texture2D surfaces;
layout(binding = 3, rgba32f) uniform writeonly image2DArray result;

const float kKernel[3] = float[3](3.0 / 8.0, 1.0 / 4.0, 1.0 / 16.0);

// The variance over 3 x 3 pixels, which alone would be noisy (equation 5), of the same surface: a pixel at its border
// has a high variance that is no noise of its neighbours.
void smoothVariances(ivec2 pixel, vec4 guide, vec2 slope, out float variances[kSignals]) {
    float weights = 0.0;
    for (int s = 0; s < kSignals; ++s) {
        variances[s] = 0.0;
    }
    for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
            ivec2 tap = pixel + ivec2(x, y);
            if (!isInside(tap)) {
                continue;
            }
            float weight = (x == 0 ? 0.5 : 0.25) * (y == 0 ? 0.5 : 0.25);
            if (x != 0 || y != 0) {
                vec2 edge = edgeDistance(guide, texelFetch(guides, tap, 0), slope, vec2(x, y));
                weight *= exp(-edge.x - kSigmaNormal * edge.y);
            }
            for (int s = 0; s < kSignals; ++s) {
                variances[s] += weight * texelFetch(lights, ivec3(tap, s), 0).w;
            }
            weights += weight;
        }
    }
    for (int s = 0; s < kSignals; ++s) {
        variances[s] /= weights;
    }
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (!isInside(pixel)) {
        return;
    }
    vec4 guide = texelFetch(guides, pixel, 0);
    if (guide.w <= 0.0) {
        for (int s = 0; s < kSignals; ++s) {
            imageStore(result, ivec3(pixel, s), texelFetch(lights, ivec3(pixel, s), 0));
        }
        return;
    }
    vec3 surface = texelFetch(surfaces, pixel, 0).xyz;
    const float middle = kKernel[0] * kKernel[0];
    vec4 sums[kSignals]; // light, and its variance
    float weights[kSignals];
    vec3 own[kSignals]; // light
    float factors[kSignals];
    float powers[kSignals];
    float variances[kSignals];
    smoothVariances(pixel, guide, surface.xy, variances);
    for (int s = 0; s < kSignals; ++s) {
        vec4 light = texelFetch(lights, ivec3(pixel, s), 0);
        sums[s] = vec4(middle * light.rgb, middle * middle * light.w);
        weights[s] = middle;
        own[s] = light.rgb;
        // Where there is no noise, nothing that differs takes part.
        factors[s] = 1.0 / (kSigmaLight * sqrt(max(variances[s], 0.0)) + 1e-6);
        powers[s] = normalPower(s, surface.z);
    }
    for (int y = -2; y <= 2; ++y) {
        for (int x = -2; x <= 2; ++x) {
            ivec2 tap = pixel + stride * ivec2(x, y);
            if ((x == 0 && y == 0) || !isInside(tap)) {
                continue;
            }
            vec2 edge =
                edgeDistance(guide, texelFetch(guides, tap, 0), surface.xy, float(stride) * vec2(x, y));
            if (edge.x + kSigmaNormal * edge.y >= kBarred) {
                continue;
            }
            for (int s = 0; s < kSignals; ++s) {
                vec4 other = texelFetch(lights, ivec3(tap, s), 0);
                float weight = kKernel[abs(x)] * kKernel[abs(y)] *
                               exp(-edge.x - powers[s] * edge.y - lightDistance(other.rgb, own[s]) * factors[s]);
                sums[s] += vec4(weight, weight, weight, weight * weight) * other;
                weights[s] += weight;
            }
        }
    }
    for (int s = 0; s < kSignals; ++s) {
        imageStore(result, ivec3(pixel, s),
                   vec4(sums[s].rgb / weights[s], sums[s].w / (weights[s] * weights[s])));
    }
}
