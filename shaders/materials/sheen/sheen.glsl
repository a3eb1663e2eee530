// Charlie sheen (KHR_materials_sheen): Estevez and Kulla, "Production Friendly Microfacet Sheen BRDF" (2017), as a
// layer. alpha = sheenRoughness², at least kMinSheenAlpha.
#include "bsdf/layer.glsl"
#include "materials/sheen/sheen_albedo.glsl"

// The NDF. sine2 = |n×h|².
float sheenDistribution(float sine2, float alpha) {
    float inverse = 1.0 / alpha;
    return (2.0 + inverse) * pow(sine2, 0.5 * inverse) * (0.5 * kInversePi);
}

float sheenLambdaFit(float x, float alpha) {
    float t = (1.0 - alpha) * (1.0 - alpha);
    float a = mix(21.5473, 25.3245, t);
    float b = mix(3.82987, 3.32435, t);
    float c = mix(0.19823, 0.16801, t);
    float d = mix(-1.97760, -1.27393, t);
    float e = mix(-4.32054, -4.85967, t);
    return a / (1.0 + b * pow(x, c)) + d * x + e;
}

float sheenLambda(float cosine, float alpha) {
    // The cosine of a unit vector may be rounded to more than 1, and powers of numbers below 0 are undefined.
    return exp(cosine < 0.5 ? sheenLambdaFit(cosine, alpha)
                            : 2.0 * sheenLambdaFit(0.5, alpha) - sheenLambdaFit(max(1.0 - cosine, 0.0), alpha));
}

// G / (4 (n·l) (n·v)). Both cosines are in (0, 1], but for rounding.
float sheenVisibility(float nDotL, float nDotV, float alpha) {
    return 1.0 / ((1.0 + sheenLambda(nDotV, alpha) + sheenLambda(nDotL, alpha)) * 4.0 * nDotL * nDotV);
}

struct Sheen {
    GLINT_RELAXED vec3 color;
    float alpha;   // at least kMinSheenAlpha
    float albedo;  // of the white lobe for the prepared view; above 1 near grazing, and the lobe is then divided by it
};

void sheenPrepare(inout Sheen layer, vec3 view) {
    layer.albedo = sheenAlbedo(view.z, layer.alpha);
}

// The share of light that reaches the base below the sheen, for one cosine: KHR_materials_sheen, albedo scaling.
GLINT_RELAXED float belowSheen(Sheen layer, float albedo) {
    GLINT_RELAXED float color = largest(layer.color);
    GLINT_RELAXED float reflected = min(albedo, 1.0);
    return max(1.0 - color * reflected, 0.0);
}

LayerAlbedo sheenShares(Sheen layer, vec3 view) {
    return LayerAlbedo(layer.color * min(layer.albedo, 1.0), belowSheen(layer, layer.albedo));
}

LayerLight sheenEvaluate(Sheen layer, vec3 view, vec3 l) {
    LayerLight light = LayerLight(vec3(0.0), belowSheen(layer, layer.albedo), l.z);
    if (l.z > 0.0) {
        float lightAlbedo = sheenAlbedo(l.z, layer.alpha);
        light.passed = min(light.passed, belowSheen(layer, lightAlbedo));
        vec3 h = normalize(view + l);
        float lobe = sheenDistribution(h.x * h.x + h.y * h.y, layer.alpha) *
                     sheenVisibility(l.z, view.z, layer.alpha) / max(max(layer.albedo, lightAlbedo), 1.0);
        light.reflected = layer.color * (lobe * l.z);
    }
    return light;
}

vec3 sheenSample(Sheen layer, vec3 view, vec2 u) {
    return sampleCosine(u);
}

float sheenDensity(Sheen layer, vec3 view, vec3 l) {
    return cosineDensity(l);
}
