// Charlie sheen (KHR_materials_sheen): Estevez and Kulla, "Production Friendly Microfacet Sheen BRDF" (2017). alpha =
// sheenRoughness², at least kMinSheenAlpha.

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
    return exp(cosine < 0.5 ? sheenLambdaFit(cosine, alpha)
                            : 2.0 * sheenLambdaFit(0.5, alpha) - sheenLambdaFit(1.0 - cosine, alpha));
}

// G / (4 (n·l) (n·v)). Both cosines are in (0, 1].
float sheenVisibility(float nDotL, float nDotV, float alpha) {
    return 1.0 / ((1.0 + sheenLambda(nDotV, alpha) + sheenLambda(nDotL, alpha)) * 4.0 * nDotL * nDotV);
}
