// The orders of light that a strand sends back, after Chiang, Bitterli, Tappan and Burley, "A Practical and
// Controllable Hair and Fur Model for Production Path Tracing" (2016): a reflection, passage, passage with a reflection
// within, and the rest. A strand is a tube along the tangent, and the normal tells the place across it. Both the sine
// along the strand and the azimuth around it have logistic distributions. The model is not reciprocal. Light through a
// strand comes by rays that follow its samples: a shadow ray behind it meets the strand's own far side.
#include "bsdf/model.glsl"

struct Hair {
    mat3 toStrand;    // turns directions: along the strand, across it, along the normal
    vec3 absorption;  // over the radius
    float roughness;
    float width;      // of the distribution around the strand
    float tilt;       // of its scales
    float ior;
    // hairPrepare() sets the others, by order:
    vec4 centres;     // of the sines along the strand
    vec4 widths;
    vec4 azimuths;    // around the strand
    mat4x3 shares;    // of the light
    vec4 chances;
};

void hairPrepare(inout Hair hair, vec3 view) {
    vec3 v = hair.toStrand * view;
    float sine2 = v.x * v.x;
    float cosine = max(length(v.yz), 1e-4);
    float ior2 = hair.ior * hair.ior;
    float across = clamp(-v.y / cosine, -1.0, 1.0);
    float bent = clamp(across * cosine / sqrt(ior2 - sine2), -1.0, 1.0);
    vec3 turns = vec3(0.0, 1.0, 2.0) * (2.0 * asin(bent) + kPi) - 2.0 * asin(across);
    hair.azimuths = atan(v.z, v.y) + vec4(turns, 0.0);  // the last order goes everywhere

    vec4 angles = asin(clamp(v.x, -1.0, 1.0)) + hair.tilt * vec4(-2.0, 1.0, 4.0, 0.0);
    float deviation = (0.726 + 0.812 * hair.roughness) * hair.roughness + 3.7 * pow(hair.roughness, 20.0);
    hair.centres = -sin(angles);
    hair.widths = 0.5513 * deviation * vec4(1.0, 0.5, 2.0, 2.0) * max(abs(cos(angles)), 0.2);  // the root of 3, over pi

    vec3 passed = exp(-2.0 * hair.absorption * sqrt((1.0 - bent * bent) / (1.0 - sine2 / ior2)));
    float facet = cosine * sqrt(1.0 - across * across);
    float g = sqrt(ior2 - 1.0 + facet * facet);
    float a = (g - facet) / (g + facet);
    float b = (facet * (g + facet) - 1.0) / (facet * (g - facet) + 1.0);
    float fresnel = min(0.5 * a * a * (1.0 + b * b), 1.0);
    vec3 once = (1.0 - fresnel) * (1.0 - fresnel) * passed;
    vec3 again = passed * fresnel;
    hair.shares = mat4x3(vec3(fresnel), once, once * again, once * again * again / max(1.0 - again, vec3(1e-6)));
    hair.chances = vec4(luminance(hair.shares[0]), luminance(hair.shares[1]), luminance(hair.shares[2]),
                        luminance(hair.shares[3]));
    hair.chances /= dot(hair.chances, vec4(1.0));
}

vec4 logistic(vec4 x) {
    return 1.0 / (1.0 + exp(-clamp(x, -80.0, 80.0)));
}

// The density of logistic distributions that are cut to [-end, end].
vec4 cutLogistic(vec4 x, vec4 centre, vec4 width, float end) {
    vec4 e = exp(-min(abs(x - centre) / width, 80.0));
    vec4 inside = logistic((end - centre) / width) - logistic((-end - centre) / width);
    return e / (width * (1.0 + e) * (1.0 + e) * max(inside, 1e-6));
}

float sampleLogistic(float u, float centre, float width, float end) {
    vec2 ends = logistic(vec2(-end - centre, end - centre).xyxy / width).xy;
    float place = clamp(mix(ends.x, ends.y, u), 1e-7, 0.9999999);
    return clamp(centre + width * log(place / (1.0 - place)), -end, end);
}

// The densities of all orders in a direction.
vec4 hairOrders(Hair hair, vec3 direction) {
    vec3 l = hair.toStrand * direction;
    vec4 turn = atan(l.z, l.y) - hair.azimuths;
    turn -= 2.0 * kPi * floor(turn / (2.0 * kPi) + 0.5);
    vec4 around = cutLogistic(turn, vec4(0.0), vec4(hair.width), kPi);
    around.w = 0.5 * kInversePi;
    return around * cutLogistic(vec4(l.x), hair.centres, hair.widths, 1.0);
}

vec3 hairEvaluate(Hair hair, vec3 view, vec3 l) {
    return hair.shares * hairOrders(hair, l);
}

float hairDensity(Hair hair, vec3 view, vec3 l) {
    return dot(hair.chances, hairOrders(hair, l));
}

vec3 hairSample(Hair hair, vec3 view, vec2 u) {
    int order = 0;
    for (; order < 3 && u.x >= hair.chances[order]; ++order) {
        u.x -= hair.chances[order];
    }
    u.x = min(u.x / max(hair.chances[order], 1e-12), 1.0);
    float sine = sampleLogistic(u.x, hair.centres[order], hair.widths[order], 1.0);
    float turn = order < 3 ? sampleLogistic(u.y, 0.0, hair.width, kPi) : 2.0 * kPi * u.y;
    float azimuth = hair.azimuths[order] + turn;
    return normalize(vec3(sine, sqrt(1.0 - sine * sine) * vec2(cos(azimuth), sin(azimuth))) * hair.toStrand);
}
