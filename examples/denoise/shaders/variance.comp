#version 460
// Estimates the variance of the mean over frames: by their moments, or over the pixels around where few frames are
// known (section 4.2 of the paper). A frame of several samples has a variance of its own, which tells noise from what
// the light looks like; the paper, with one sample, can't.
#extension GL_GOOGLE_include_directive : require
#include "svgf.glsl"

layout(binding = 0) uniform texture2DArray lights;
layout(binding = 1) uniform texture2DArray moments;
layout(binding = 2) uniform texture2D guides;
layout(binding = 3) uniform texture2D surfaces;
layout(binding = 4, rgba32f) uniform writeonly image2DArray result; // light, variance

// With fewer frames the pixels around are asked.
const float kFewFrames = 4.0;

// The light of a pixel, no brighter than the brightest around it if chance explains the difference: one sample that
// found a small light outweighs all others while frames are few.
vec3 withoutFirefly(ivec2 pixel, int s, vec3 light, float variance) {
    float most = 0.0;
    for (int i = 0; i < 9; ++i) {
        ivec2 tap = pixel + ivec2(i % 3, i / 3) - 1;
        if (i != 4 && isInside(tap)) {
            most = max(most, luminance(texelFetch(lights, ivec3(tap, s), 0).rgb));
        }
    }
    float own = luminance(light);
    return own > most && own - most < 2.0 * sqrt(variance) ? light * (most / own) : light;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (!isInside(pixel)) {
        return;
    }
    vec4 guide = texelFetch(guides, pixel, 0);
    bool isNew = false;
    vec4 sums[kSignals]; // luminance, its square, variance by samples, weights
    for (int s = 0; s < kSignals; ++s) {
        vec4 moment = texelFetch(moments, ivec3(pixel, s), 0);
        sums[s] = vec4(moment.xyw, 1.0);
        isNew = isNew || moment.z < kFewFrames;
    }
    if (isNew && guide.w > 0.0) {
        vec3 surface = texelFetch(surfaces, pixel, 0).xyz;
        float powers[kSignals];
        for (int s = 0; s < kSignals; ++s) {
            powers[s] = normalPower(s, surface.z);
        }
        int reach = samples > 1u ? 2 : 3;
        for (int y = -reach; y <= reach; ++y) {
            for (int x = -reach; x <= reach; ++x) {
                ivec2 tap = pixel + ivec2(x, y);
                if ((x == 0 && y == 0) || !isInside(tap)) {
                    continue;
                }
                vec2 edge = edgeDistance(guide, texelFetch(guides, tap, 0), surface.xy, vec2(x, y));
                if (edge.x >= kBarred) {
                    continue;
                }
                for (int s = 0; s < kSignals; ++s) {
                    float weight = exp(-edge.x - powers[s] * edge.y);
                    sums[s] += weight * vec4(texelFetch(moments, ivec3(tap, s), 0).xyw, 1.0);
                }
            }
        }
    }
    for (int s = 0; s < kSignals; ++s) {
        vec4 light = texelFetch(lights, ivec3(pixel, s), 0);
        float frames = texelFetch(moments, ivec3(pixel, s), 0).z;
        vec3 mean = sums[s].xyz / sums[s].w;
        if (frames < kFewFrames) {
            float own = texelFetch(moments, ivec3(pixel, s), 0).w;
            light.rgb = withoutFirefly(pixel, s, light.rgb, samples > 1u ? own / frames : 1e30);
        }
        float ofFrame = samples > 1u ? mean.z : max(mean.y - mean.x * mean.x, 0.0);
        float share = shareOf(frames);
        imageStore(result, ivec3(pixel, s), vec4(light.rgb, guide.w > 0.0 ? light.w + share * share * ofFrame : 0.0));
    }
}
