// Fuzz of OpenPBR: the volume of fibres of Zeltner, Burley and Chiang, "Practical Multiple-Scattering Sheen Using Linearly
// Transformed Cosines" (2022). A cosine lobe is transformed linearly, so its samples and its density are exact. The
// coefficients are the rational fits that MaterialX has for that paper.
#include "bsdf/layer.glsl"

struct Fuzz {
    GLINT_RELAXED vec3 color;
    GLINT_RELAXED float factor;
    float roughness;  // at least kMinFuzzRoughness
    // fuzzPrepare() sets the others:
    float a;       // the transform to the cosine lobe: x' = a x + b z, y' = a y, z' = z, x towards the view
    float b;
    float albedo;  // share of a white sky that white fibres reflect
    vec2 across;   // the direction of the view in the plane of the surface
};

// The fits hold from here to 1.
const float kMinFuzzRoughness = 0.07;

void fuzzPrepare(inout Fuzz layer, vec3 view) {
    float x = min(view.z, 1.0);
    float y = layer.roughness;
    float spread = y * (0.0206607 + 1.58491 * y) / (0.0379424 + y * (1.32227 + y));
    float centre = y * (-0.193854 + y * (-1.14885 + y * (1.7932 - 0.95943 * y * y))) / (0.046391 + y);
    float offset = y * (0.000654023 + (-0.0207818 + 0.119681 * y) * y) / (1.26264 + y * (-1.92021 + y));
    float distance = (x - centre) / spread;
    layer.albedo = clamp(exp(-0.5 * distance * distance) / (spread * sqrt(2.0 * kPi)) + offset, 0.0, 1.0);
    layer.a = (2.58126 * x + 0.813703 * y) * y / (1.0 + 0.310327 * x * x + 2.60994 * x * y);
    layer.b = sqrt(1.0 - x) * (y - 1.0) * y * y * y / (0.0000254053 + 1.71228 * x - 1.71506 * x * y + 1.34174 * y * y);
    float length2 = dot(view.xy, view.xy);
    layer.across = length2 > 0.0 ? view.xy * inversesqrt(length2) : vec2(1.0, 0.0);
}

LayerAlbedo fuzzShares(Fuzz layer, vec3 view) {
    float reflected = layer.factor * layer.albedo;
    return LayerAlbedo(layer.color * reflected, 1.0 - reflected);
}

float fuzzDensity(Fuzz layer, vec3 view, vec3 l) {
    if (l.z <= 0.0) {
        return 0.0;
    }
    vec2 local = vec2(dot(layer.across, l.xy), layer.across.x * l.y - layer.across.y * l.x);
    vec3 cosineLobe = vec3(layer.a * local.x + layer.b * l.z, layer.a * local.y, l.z);
    float length2 = dot(cosineLobe, cosineLobe);
    // The Jacobian is the determinant a² over the cube of the length.
    float ratio = layer.a / length2;
    return l.z * kInversePi * ratio * ratio;
}

LayerLight fuzzEvaluate(Fuzz layer, vec3 view, vec3 l) {
    return LayerLight(layer.color * (layer.factor * layer.albedo * fuzzDensity(layer, view, l)),
                      1.0 - layer.factor * layer.albedo, l.z);
}

vec3 fuzzSample(Fuzz layer, vec3 view, vec2 u) {
    vec3 cosineLobe = sampleCosine(u);
    vec2 local = vec2(cosineLobe.x - layer.b * cosineLobe.z, cosineLobe.y) / layer.a;
    vec2 plane = local.x * layer.across + local.y * vec2(-layer.across.y, layer.across.x);
    return normalize(vec3(plane, cosineLobe.z));
}
