// Shared by the passes of the filter: Schied et al., "Spatiotemporal Variance-Guided Filtering: Real-Time
// Reconstruction for Path-Traced Global Illumination" (HPG 2017). Numbers of equations are those of the paper.
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 8, local_size_y = 8) in;

// A signal is the light of one source. Images of all signals are arrays, so that the weights between two pixels are
// computed once for all of them.
layout(constant_id = 0) const int kSignals = 1;

layout(push_constant) uniform Push {
    ivec2 size;
    int stride;          // of a pass of the wavelet, pixels
    int signal;          // of passes that treat one
    uint virtualSignals; // bits of the signals that are what a surface shows, not its own light
    uint isFirst;        // there is no frame before, or no sum before
    uint samples;        // of a pixel in a frame
    float alpha;         // least weight of a new frame
};

// The constants of section 4.4, except for light: the paper's 4 deviations allow for an estimate of the noise that is
// bad. Equation 4 raises a cosine to a power; cos^n is exp(-n (1 - cos)) where it matters.
const float kSigmaDepth = 1.0;
const float kSigmaNormal = 128.0;
const float kSigmaLight = 1.5;
const float kSigmaMixed = 20.0; // of what the lengths of two mean normals lack
// Weights of less than exp(-kBarred) count as none.
const float kBarred = 12.0;
// Light of a mirror follows its image; that of a rougher surface than this is spread over the surface.
const float kImageRoughness = 0.4;

float luminance(vec3 color) {
    return dot(color, vec3(0.2126, 0.7152, 0.0722));
}

// How much two lights differ: equation 5, but luminance would not see a difference of colour alone. Light that two
// lobes bring is no less textured for its division by the albedo of both.
float lightDistance(vec3 light, vec3 other) {
    return dot(abs(light - other), vec3(1.0 / 3.0));
}

bool isInside(ivec2 pixel) {
    return all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, size));
}

bool isVirtual(int signal) {
    return (virtualSignals >> uint(signal) & 1u) != 0u;
}

// How far a pixel is from being part of the same surface: exponents of equations 3 (x) and 4 (y, without the power).
// Guides are mean normals and depths. Normals are shorter where the samples of a pixel see several surfaces. Such a
// pixel has the light of all of them, which belongs to none of its neighbours.
vec2 edgeDistance(vec4 guide, vec4 other, vec2 slope, vec2 offset) {
    if (other.w <= 0.0) {
        return vec2(kBarred, 2.0);
    }
    float expected = kSigmaDepth * dot(slope, abs(offset)) + 1e-3 * guide.w;
    float length1 = max(length(guide.xyz), 1e-3);
    float length2 = max(length(other.xyz), 1e-3);
    return vec2(abs(guide.w - other.w) / expected + kSigmaMixed * max(2.0 - length1 - length2, 0.0),
                max(1.0 - dot(guide.xyz, other.xyz) / (length1 * length2), 0.0));
}

// The power of equation 4. What a smooth surface shows changes with its normal, within the width of its lobe: a facet
// turned by alpha sends the view to where the lobe has fallen to 1 / e.
float normalPower(int signal, float roughness) {
    float alpha = roughness * roughness;
    return isVirtual(signal) ? clamp(2.0 / max(alpha * alpha, 1e-4), kSigmaNormal, 1e4) : kSigmaNormal;
}

// How much of a signal a new frame is after so many frames: all count alike at first.
float shareOf(float frames) {
    return max(alpha, 1.0 / frames);
}
