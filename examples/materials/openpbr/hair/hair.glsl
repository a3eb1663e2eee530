// The orders of light that a strand sends back, after Chiang, Bitterli, Tappan and Burley, "A Practical and
// Controllable Hair and Fur Model for Production Path Tracing" (2016): a reflection, passage, passage with a reflection
// within, and the rest. A strand is a tube along the tangent, and the normal tells the place across it. The
// distribution of the sine along the strand is logistic here, as that of the azimuth is. It is not reciprocal. Light
// through a strand comes by rays that follow its samples: a shadow ray behind it meets the strand's own far side.
#include "bsdf/model.glsl"

struct Hair {
    vec2 along;       // the strand in the plane of the surface, a unit vector
    vec3 absorption;  // over the radius
    float roughness;
    float width;      // of the distribution around the strand
    float tilt;       // of its scales
    float ior;
    vec3 view;        // hairPrepare() sets this, along the strand, across it and along the normal, and the rest
    vec2 gamma;       // the angle between it and the normal about the strand, outside and within
    vec3 shares[4];   // of the light, by order
    vec4 chances;
};

vec3 hairTurned(Hair hair, vec3 d) {
    return vec3(dot(hair.along, d.xy), hair.along.x * d.y - hair.along.y * d.x, d.z);
}

void hairPrepare(inout Hair hair, vec3 view) {
    hair.view = hairTurned(hair, view);
    float sine2 = hair.view.x * hair.view.x;
    float cosine = max(length(hair.view.yz), 1e-4);
    float ior2 = hair.ior * hair.ior;
    float across = clamp(-hair.view.y / cosine, -1.0, 1.0);
    float bent = clamp(across * cosine / sqrt(ior2 - sine2), -1.0, 1.0);
    hair.gamma = asin(vec2(across, bent));
    vec3 passed = exp(-2.0 * hair.absorption * sqrt((1.0 - bent * bent) / (1.0 - sine2 / ior2)));
    float facet = cosine * sqrt(1.0 - across * across);
    float g = sqrt(ior2 - 1.0 + facet * facet);
    float a = (g - facet) / (g + facet);
    float b = (facet * (g + facet) - 1.0) / (facet * (g - facet) + 1.0);
    float fresnel = min(0.5 * a * a * (1.0 + b * b), 1.0);
    hair.shares[0] = vec3(fresnel);
    hair.shares[1] = (1.0 - fresnel) * (1.0 - fresnel) * passed;
    hair.shares[2] = hair.shares[1] * passed * fresnel;
    hair.shares[3] = hair.shares[2] * passed * fresnel / max(1.0 - passed * fresnel, vec3(1e-6));
    hair.chances = vec4(luminance(hair.shares[0]), luminance(hair.shares[1]), luminance(hair.shares[2]),
                        luminance(hair.shares[3]));
    hair.chances /= dot(hair.chances, vec4(1.0));
}

// The distribution of an order along the strand: its centre and width, of the sine.
vec2 hairLobe(Hair hair, int order) {
    float turn = order == 0 ? -2.0 : order == 1 ? 1.0 : order == 2 ? 4.0 : 0.0;
    float angle = asin(clamp(hair.view.x, -1.0, 1.0)) + turn * hair.tilt;
    float r = hair.roughness;
    float deviation = (0.726 * r + 0.812 * r * r + 3.7 * pow(r, 20.0)) * (order == 0 ? 1.0 : order == 1 ? 0.5 : 2.0);
    return vec2(-sin(angle), 0.5513 * deviation * max(abs(cos(angle)), 0.2));  // the square root of 3, over pi
}

// The azimuth at which an order leaves, from the view's.
float hairTurn(Hair hair, int order) {
    return 2.0 * float(order) * hair.gamma.y - 2.0 * hair.gamma.x + float(order) * kPi;
}

float logistic(float x) {
    return 1.0 / (1.0 + exp(-clamp(x, -80.0, 80.0)));
}

// The logistic density of this width, cut to an interval, at x from its centre.
float cutLogistic(float x, float width, float low, float high) {
    float e = exp(-min(abs(x) / width, 80.0));
    return e / (width * (1.0 + e) * (1.0 + e) * max(logistic(high / width) - logistic(low / width), 1e-6));
}

float sampleLogistic(float u, float width, float low, float high) {
    float place = clamp(mix(logistic(low / width), logistic(high / width), u), 1e-7, 0.9999999);
    return clamp(width * log(place / (1.0 - place)), low, high);
}

// The densities of all orders in a direction. The last one goes everywhere around the strand.
vec4 hairOrders(Hair hair, vec3 direction) {
    vec3 l = hairTurned(hair, direction);
    float azimuth = atan(l.z, l.y) - atan(hair.view.z, hair.view.y);
    vec4 parts;
    for (int order = 0; order < 4; ++order) {
        vec2 lobe = hairLobe(hair, order);
        float x = azimuth - hairTurn(hair, order);
        x -= 2.0 * kPi * floor(x / (2.0 * kPi) + 0.5);
        parts[order] = cutLogistic(l.x - lobe.x, lobe.y, -1.0 - lobe.x, 1.0 - lobe.x) *
                       (order < 3 ? cutLogistic(x, hair.width, -kPi, kPi) : 0.5 * kInversePi);
    }
    return parts;
}

vec3 hairEvaluate(Hair hair, vec3 view, vec3 l) {
    vec4 parts = hairOrders(hair, l);
    return hair.shares[0] * parts.x + hair.shares[1] * parts.y + hair.shares[2] * parts.z + hair.shares[3] * parts.w;
}

float hairDensity(Hair hair, vec3 view, vec3 l) {
    return dot(hair.chances, hairOrders(hair, l));
}

vec3 hairSample(Hair hair, vec3 view, vec2 u) {
    int order = 0;
    for (; order < 3 && u.x >= hair.chances[order]; ++order) {
        u.x -= hair.chances[order];
    }
    vec2 lobe = hairLobe(hair, order);
    float sine = clamp(lobe.x + sampleLogistic(min(u.x / max(hair.chances[order], 1e-12), 1.0), lobe.y, -1.0 - lobe.x,
                                               1.0 - lobe.x), -1.0, 1.0);
    float azimuth = atan(hair.view.z, hair.view.y) +
                    (order < 3 ? hairTurn(hair, order) + sampleLogistic(u.y, hair.width, -kPi, kPi) : 2.0 * kPi * u.y);
    vec2 around = sqrt(1.0 - sine * sine) * vec2(cos(azimuth), sin(azimuth));
    return normalize(vec3(hair.along * sine + vec2(-hair.along.y, hair.along.x) * around.x, around.y));
}
