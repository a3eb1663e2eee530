// What the passes of the filter share: Schied et al., "Spatiotemporal Variance-Guided Filtering: Real-Time
// Reconstruction for Path-Traced Global Illumination" (HPG 2017). Numbers of equations are those of the paper.
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 8, local_size_y = 8) in;

layout(push_constant) uniform Push {
    ivec2 size;
    int stride;     // of a pass of the wavelet, pixels
    float alpha;    // least weight of a new frame
    uint isFirst;   // there is no frame before, or no sum before
    uint isVirtual; // motion is that of what a surface shows, not its own
    uint samples;   // of a pixel in a frame
};

// The constants of section 4.4.
const float kSigmaDepth = 1.0;
const float kSigmaNormal = 128.0;
const float kSigmaLight = 4.0;

float luminance(vec3 color) {
    return dot(color, vec3(0.2126, 0.7152, 0.0722));
}

bool isInside(ivec2 pixel) {
    return all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, size));
}

// Normals are means over samples, and shorter where surfaces meet.
vec3 unit(vec3 v) {
    return v / max(length(v), 1e-6);
}

// How fast the depth changes about a pixel, metres a pixel, from the nearer neighbour on each axis.
vec2 depthSlope(texture2D depths, ivec2 pixel, float depth) {
    vec2 slope = vec2(0.0);
    for (int axis = 0; axis < 2; ++axis) {
        ivec2 next = axis == 0 ? ivec2(1, 0) : ivec2(0, 1);
        float before = isInside(pixel - next) ? abs(depth - texelFetch(depths, pixel - next, 0).x) : 1e9;
        float behind = isInside(pixel + next) ? abs(depth - texelFetch(depths, pixel + next, 0).x) : 1e9;
        slope[axis] = min(before, behind);
    }
    return slope;
}

// The weights of equations 3 and 4, between two pixels whose distance is `offset`.
float edgeWeight(float depth, float otherDepth, vec2 slope, vec2 offset, vec3 normal, vec3 otherNormal) {
    if (otherDepth <= 0.0) {
        return 0.0;
    }
    float expected = kSigmaDepth * dot(slope, abs(offset)) + 1e-3 * depth;
    return exp(-abs(depth - otherDepth) / expected) * pow(max(dot(normal, otherNormal), 0.0), kSigmaNormal);
}
