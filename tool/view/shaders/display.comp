#version 460
// Encodes linear radiance for a display, as tool/image/tone.h does: exposure, the Khronos PBR Neutral tone
// mapper, sRGB. Shows one picture, two with a border between them, or the difference of the two.
layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0, rgba32f) readonly uniform image2D first;
layout(binding = 1, rgba32f) readonly uniform image2D second;
layout(binding = 2, rgba8) writeonly uniform image2D shown;

layout(push_constant) uniform Constants {
    float scale;     // 2^exposure
    uint view;       // kFirst to kDifference
    float border;    // with kWipe: the share of the width that shows the first picture
    float gain;      // with kDifference: factor of the difference of encoded values
};

const uint kFirst = 0u;
const uint kSecond = 1u;
const uint kWipe = 2u;
const uint kDifference = 3u;

vec3 toneMapNeutral(vec3 color) {
    const float fresnel = 0.04;
    const float start = 0.8 - fresnel;
    const float desaturation = 0.15;
    float smallest = min(color.r, min(color.g, color.b));
    color -= smallest <= 2.0 * fresnel ? smallest - smallest * smallest / (4.0 * fresnel) : fresnel;
    float peak = max(color.r, max(color.g, color.b));
    if (peak <= start) {
        return color;
    }
    float range = 1.0 - start;
    float compressed = 1.0 - range * range / (peak + range - start);
    float saturation = 1.0 / (desaturation * (peak - compressed) + 1.0);
    return mix(vec3(compressed), color / peak * compressed, saturation);
}

vec3 encoded(vec3 color) {
    return mix(1.055 * pow(color, vec3(1.0 / 2.4)) - 0.055, 12.92 * color, lessThanEqual(color, vec3(0.0031308)));
}

vec3 displayed(vec3 color) {
    if (any(isnan(color)) || any(isinf(color))) {
        return vec3(1.0, 0.0, 1.0);
    }
    return encoded(clamp(toneMapNeutral(clamp(color * scale, 0.0, 1e30)), 0.0, 1.0));
}

// While the window changes its size, pictures have another one for a moment.
ivec2 placeIn(ivec2 pixel, ivec2 size, ivec2 pictureSize) {
    return size == pictureSize ? pixel : min(pixel * pictureSize / size, pictureSize - 1);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = imageSize(shown);
    if (any(greaterThanEqual(pixel, size))) {
        return;
    }
    vec4 a = imageLoad(first, placeIn(pixel, size, imageSize(first)));
    vec3 color = displayed(a.rgb);
    if (view != kFirst) {
        vec3 other = displayed(imageLoad(second, placeIn(pixel, size, imageSize(second))).rgb);
        int column = int(border * float(size.x));
        if (view == kDifference) {
            color = min(abs(color - other) * gain, 1.0);
        } else if (view == kSecond || pixel.x > column) {
            color = other;
        }
        if (view == kWipe && pixel.x == column) {
            color = vec3(1.0);
        }
    }
    imageStore(shown, pixel, vec4(color, 1.0));
}
