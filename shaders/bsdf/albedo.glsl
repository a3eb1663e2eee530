// Directional albedos in closed form: what a lobe reflects of a uniform white sky. Constants and bounds come from
// scripts/fit_directional_albedo.py, which checks them in single precision against quadrature. The fits err on the high
// side, so that the terms that take the rest add no light.
#include "bsdf/constants.glsl"

// 0.07². Below alpha = 0.068 the lobe of KHR_materials_sheen reflects more than it receives near grazing, up to 2.94
// times as much at this alpha. Where n·v is below 6e-6 it does so at any alpha. Divided by max(1, E(v), E(l)), the lobe
// makes no light and stays reciprocal.
const float kMinSheenAlpha = 0.0049;

// Albedo of a single-scatter GGX lobe, alpha in [1e-4, 1]. x is 1 - E, where E is the albedo of white microfacets; it
// keeps its digits if alpha is small. y is the part of E that Schlick's (1 - v·h)⁵ weights. E and y exceed the truth by
// at most 6e-3 and fall short by at most 2e-4; if nDotV is below 1e-3, by 7e-3 and 3e-3. 0 <= y <= E <= 1. The y of a
// mirror is (1 - n·v)⁵.
vec2 ggxAlbedo(float nDotV, float alpha) {
    float a = alpha;
    float a2 = a * a;
    float n2 = nDotV * nDotV;
    // The lowest terms of each fraction have the same degree in nDotV and alpha, because the loss of a smooth lobe is a
    // function of their ratio.
    float lost = nDotV * a2 *
                 (0.1974063 + 0.7082196 * a2 + nDotV * (0.1156772 + a * (0.2777179 + a * 2.765653)));
    float all = a2 * (a * (1.0 + a * (-2.256997 + a * (2.191374 - 0.7307094 * a))) +
                      nDotV * (0.5940123 + 2.222831 * a)) +
                n2 * (a * (-0.1239762 + a * (0.550922 + 2.027213 * a2)) + nDotV * (0.3813426 + 0.0187559 * a));
    float loss = lost / all;
    // Schlick's weight at the cosine between view and half vector that gives the mean weight.
    float roughness = sqrt(a);
    float shift = a2 *
                  (a * (8.235557 + 13.27825 * roughness) + nDotV * roughness * (17.42174 - 40.69226 * roughness) -
                   24.25735 * n2 * nDotV) /
                  (a2 * (1.0 + roughness * (17.05333 + 30.21491 * a)) +
                   nDotV * (a * (0.8381407 + 13.68742 * roughness) + nDotV * (0.07524006 + 6.138967 * roughness)));
    float m = clamp(1.0 - nDotV - shift, 0.0, 1.0);
    float m2 = m * m;
    return vec2(loss, (1.0 - loss) * m2 * m2 * m);
}

// 2 ∫ ggxAlbedo(μ) μ dμ of exactly these fits, so that losses and their mean cancel: 1 - S̄, where S = f0 (E - y) + f90
// y, is 0.9997 to 1.01 times its integral, for all f0 <= f90 <= 1. The logarithm comes from the tail of the loss,
// alpha² / n·v².
vec2 ggxMeanAlbedo(float alpha) {
    float a2 = alpha * alpha;
    float loss = 0.2189529 + a2 * (34.89501 * alpha - 34.52422) -
                 log2(alpha) * (0.7132721 + alpha * (alpha * (13.40621 + 11.68229 * alpha) - 0.5533438));
    return vec2(a2 * loss, 0.0390746 + alpha * (-0.08094045 + 0.04194681 * alpha));
}

// 1 / (n·v (1 + sheenLambda())), accurate to 0.4% near grazing and to 4% elsewhere. sheenLambda() is the exponential of
// a number up to 17, which multiplies rounding errors by as much, and 1 - E would show them. The terms of a sum here
// are at most 3 times the sum in all.
float sheenMasking(float nDotV, float alpha) {
    float t = (1.0 - alpha) * (1.0 - alpha);
    float s = sqrt(nDotV);
    float passed = 5.171772e-5 + t * (-3.51232e-5 + t * 7.725224e-6) +
                   s * (0.03570185 + t * (-0.001090869 - t * 0.0007662286)) +
                   nDotV * (1.89315 - 0.2745052 * t * t - s * 0.9185604 +
                            nDotV * (0.2680311 * t + nDotV * (0.1434521 + 0.0418169 * t)));
    float all = -2.014925e-6 + t * (8.578958e-7 + t * 6.009621e-8) +
                s * (0.03862563 + t * (0.04030958 + t * 0.01106093)) +
                nDotV * (1.0 + t * (0.8363 + t * 0.4054448) + s * 0.1632464 +
                         nDotV * t * (-0.470547 + nDotV * (-0.4858494 - t * 0.2979048)));
    return passed / all;
}

// Albedo of the white sheen lobe, alpha in [kMinSheenAlpha, 1]. It exceeds the truth by at most 1e-2 and falls short by
// at most 2e-4, relative to max(1, truth). It exceeds 1 where the lobe does. Single precision is off by at most 9e-7,
// relative to the same.
float sheenAlbedo(float nDotV, float alpha) {
    nDotV = max(nDotV, kMinViewCosine);
    float r = sqrt(alpha);
    float lit = r * (0.4030607 + 0.1935443 * r + 0.3918034 * alpha) +
                nDotV * (0.06987398 + 3.589921 * r + 3.99786 * alpha +
                         nDotV * (-1.484866 - 7.446093 * r + 9.354105 * alpha + nDotV * (3.277422 - 6.018421 * r)));
    float all = alpha * (1.0 + 0.5405576 * r) + 0.0444222 * sqrt(nDotV) * r +
                nDotV * (r * (1.820475 + 16.75117 * r) + nDotV * (2.094286 + 9.516045 * alpha));
    // The density of facets that reflect into the upper hemisphere falls like a bell curve in n·v. The masking of the
    // view is that of the lobe.
    float bell = exp2(-0.2 * nDotV * nDotV / alpha);
    return bell * max(lit, 0.0) / all * sheenMasking(nDotV, alpha);
}
