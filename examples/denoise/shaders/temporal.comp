#version 460
// Adds a frame to the mean of those before it, which motion finds: section 4.1 of the paper.
#extension GL_GOOGLE_include_directive : require
#include "svgf.glsl"

layout(binding = 0) uniform texture2D light;
layout(binding = 1) uniform texture2D motion;
layout(binding = 2) uniform texture2D virtualMotion;
layout(binding = 3) uniform texture2D sampled; // variance of the luminance of samples, not demodulated
layout(binding = 4) uniform texture2D albedo;
layout(binding = 5) uniform texture2D guides;
layout(binding = 6) uniform texture2D surfaces;
layout(binding = 7) uniform texture2D lastGuides;
layout(binding = 8) uniform texture2DArray lastLights; // filtered once, with their variance
layout(binding = 9) uniform texture2DArray lastMoments;
layout(binding = 10, rgba32f) uniform writeonly image2DArray lights; // with what the frames before add to the variance
// First and second moment of the frames' luminance, frames, and the variance of a frame by that of its samples.
layout(binding = 11, rgba32f) uniform writeonly image2DArray moments;

// The mean of this frame's light about a pixel, and its deviation.
void spread(ivec2 pixel, out vec3 mean, out vec3 deviation) {
    vec3 sum = vec3(0.0);
    vec3 squares = vec3(0.0);
    float count = 0.0;
    for (int i = 0; i < 9; ++i) {
        ivec2 tap = pixel + ivec2(i % 3, i / 3) - 1;
        if (isInside(tap)) {
            vec3 value = texelFetch(light, tap, 0).rgb;
            sum += value;
            squares += value * value;
            count += 1.0;
        }
    }
    mean = sum / count;
    deviation = sqrt(max(squares / count - mean * mean, vec3(0.0)));
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (!isInside(pixel)) {
        return;
    }
    vec3 value = texelFetch(light, pixel, 0).rgb;
    vec4 guide = texelFetch(guides, pixel, 0);
    vec3 surface = texelFetch(surfaces, pixel, 0).xyz;
    bool followsImage = isVirtual(signal) && surface.z < kImageRoughness;
    vec3 step = followsImage ? texelFetch(virtualMotion, pixel, 0).xyz : texelFetch(motion, pixel, 0).xyz;
    vec2 last = vec2(pixel) + step.xy;
    ivec2 corner = ivec2(floor(last));
    // The point that a mirror shows has no depth in the frame before. The mirror itself was there.
    float expected = followsImage ? guide.w : guide.w + step.z;
    float tolerance = followsImage ? 0.2 * expected : 0.02 * expected + 2.0 * (surface.x + surface.y);
    vec4 before = vec4(0.0);
    vec4 momentsBefore = vec4(0.0);
    float weights = 0.0;
    for (int i = 0; i < 4 && isFirst == 0u && guide.w > 0.0; ++i) {
        ivec2 tap = corner + ivec2(i & 1, i >> 1);
        if (!isInside(tap)) {
            continue;
        }
        vec4 tapGuide = texelFetch(lastGuides, tap, 0);
        bool isSame =
            tapGuide.w > 0.0 && abs(tapGuide.w - expected) < tolerance && dot(tapGuide.xyz, guide.xyz) > 0.9 * length(tapGuide.xyz) * length(guide.xyz);
        vec2 near = 1.0 - abs(last - vec2(tap));
        float weight = isSame ? near.x * near.y : 0.0;
        before += weight * texelFetch(lastLights, ivec3(tap, signal), 0);
        momentsBefore += weight * texelFetch(lastMoments, ivec3(tap, signal), 0);
        weights += weight;
    }
    float scale = max(luminance(texelFetch(albedo, pixel, 0).rgb), 1e-4);
    float first = luminance(value);
    vec4 moment = vec4(first, first * first, 1.0, texelFetch(sampled, pixel, 0).x / (scale * scale * float(samples)));
    float varianceBefore = 0.0;
    if (weights > 0.01) {
        before /= weights;
        momentsBefore /= weights;
        moment.z = momentsBefore.z + 1.0;
        float share = shareOf(moment.z);
        value = mix(before.rgb, value, share);
        moment.xyw = mix(momentsBefore.xyw, moment.xyw, share);
        varianceBefore = (1.0 - share) * (1.0 - share) * before.w;
    }
    imageStore(lights, ivec3(pixel, signal), vec4(value, varianceBefore));
    imageStore(moments, ivec3(pixel, signal), moment);
}
