// Directional albedos in closed form: what a lobe reflects of a uniform white sky. Constants and bounds come from
// scripts/fit_directional_albedo.py, which checks them in single precision against quadrature. The fits err on the high
// side, so that the terms that take the rest add no light.
#include "bsdf/constants.glsl"

// 0.07². Below alpha = 0.068 the lobe of KHR_materials_sheen reflects more than it receives near grazing, up to 2.94
// times as much at this alpha. Where n·v is below 6e-6 it does so at any alpha. Divided by max(1, E(v), E(l)), the lobe
// makes no light and stays reciprocal.
const float kMinSheenAlpha = 0.0049;

// The share that white microfacets lose by single scattering: ggxAlbedo().x.
float ggxLoss(float nDotV, float alpha) {
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
    return lost / all;
}

// The cosine between view and half vector at which Schlick's weight is the mean weight, minus nDotV.
float ggxShift(float nDotV, float alpha) {
    float a = alpha;
    float a2 = a * a;
    float roughness = sqrt(a);
    return a2 *
           (a * (8.235557 + 13.27825 * roughness) + nDotV * roughness * (17.42174 - 40.69226 * roughness) -
            24.25735 * nDotV * nDotV * nDotV) /
           (a2 * (1.0 + roughness * (17.05333 + 30.21491 * a)) +
            nDotV * (a * (0.8381407 + 13.68742 * roughness) + nDotV * (0.07524006 + 6.138967 * roughness)));
}

vec2 albedoAt(float loss, float cosine) {
    float m = clamp(1.0 - cosine, 0.0, 1.0);
    float m2 = m * m;
    return vec2(loss, (1.0 - loss) * m2 * m2 * m);
}

// Albedo of a single-scatter GGX lobe, alpha in [1e-4, 1]. x is 1 - E, where E is the albedo of white microfacets; it
// keeps its digits if alpha is small. y is the part of E that Schlick's (1 - v·h)⁵ weights. E and y exceed the truth by
// at most 6e-3 and fall short by at most 2e-4; if nDotV is below 1e-3, by 7e-3 and 3e-3. 0 <= y <= E <= 1. The y of a
// mirror is (1 - n·v)⁵.
vec2 ggxAlbedo(float nDotV, float alpha) {
    return albedoAt(ggxLoss(nDotV, alpha), nDotV + ggxShift(nDotV, alpha));
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

// The alpha of the isotropic lobe that loses about as much as an anisotropic one.
float likeIsotropic(float larger, float ratio) {
    return larger * (1.0 - 0.22 * (1.0 - ratio) * sqrt(larger));
}

// ggxAlbedo() of an anisotropic lobe, alpha.x >= alpha.y. Between grooves along y, no facet changes the part of a
// direction along them, so the loss depends on the rest of the view alone. The fit knows the view with this part
// shortened by the ratio of the alphas, and is ggxAlbedo() if they are equal. E exceeds the truth by at most 1e-2, below
// a cosine of 0.05 by at most 1.8e-2, and falls short by at most 2e-3, below a cosine of 1e-3 by 4e-3. y exceeds the
// truth by at most 6e-2, for views across the grooves near grazing, and falls short by as little as E.
vec2 anisotropicGgxAlbedo(vec3 v, vec2 alpha) {
    float larger = alpha.x;
    float ratio = alpha.y / alpha.x;
    float shortened = ratio * v.y;
    float size = sqrt(v.z * v.z + v.x * v.x + shortened * shortened);
    float cosine = v.z / size;
    float along2 = v.x * v.x / (size * size);
    float change =
        -0.077007 + 0.03531598 * along2 * along2 +
        larger * (along2 * (-0.7711984 - 0.2279319 * along2 * along2) +
                  larger * (-0.7612256 + 0.9750253 * along2 +
                            larger * (1.273515 - 0.3085845 * along2 - 0.5572752 * larger))) +
        ratio * (larger * (-0.4126142 + along2 * (1.054066 * larger - 1.134699)) + 0.05162086 * ratio * along2 * along2) +
        cosine * (1.048589 - 0.09434109 * along2 * along2 * along2 + larger * larger * (0.5907374 * along2 - 0.4909076) +
                  0.475225 * ratio * ratio * along2 +
                  cosine * (-3.134041 + larger * (0.8910212 - 0.9274723 * along2) +
                            ratio * (-0.855289 + 0.9241211 * larger + 0.2766631 * ratio) +
                            cosine * (3.323889 - 1.680387 * cosine)));
    float loss = ggxLoss(cosine, likeIsotropic(larger, ratio)) * (1.0 + (1.0 - ratio) * change);
    // The alpha along the view.
    vec2 slope = alpha * v.xy;
    float a = clamp(sqrt(dot(slope, slope) / max(dot(v.xy, v.xy), 1e-12)), kMinAlpha, 1.0);
    float shift = ggxShift(v.z, a);
    float further =
        -0.6991083 - 1.30728 * a + 2.139458 * ratio +
        size * (2.37751 + 3.01326 * a - 7.973229 * ratio +
                size * (-2.43892 - 1.716259 * a + 5.934398 * ratio + 0.66923 * size)) +
        cosine * (-0.1421445 - 0.3743089 * a * a + ratio * (1.222041 - 4.495758 * ratio) +
                  size * (0.5239388 * ratio - 1.891122 * a + 1.255972 * size) -
                  cosine * (0.1149143 + 1.464606 * size));
    shift += (1.0 - ratio) * (shift * further - 0.106513 * larger * v.z * cosine);
    return albedoAt(loss, v.z + shift);
}

// ggxMeanAlbedo() of exactly this fit, over all azimuths. If S is as there, 1 - S̄ is 0.99 to 1.0003 times its
// integral, or falls short by less than 7e-4.
vec2 anisotropicGgxMeanAlbedo(vec2 alpha) {
    float ratio = alpha.y / alpha.x;
    float roughness = sqrt(alpha.x);
    float change = 0.03235323 + ratio * (-0.4034162 + ratio * (-0.114043 + ratio * (0.314674 * ratio - 0.5263376))) +
                   roughness * (-2.953443 + ratio * (-0.464126 + ratio * (2.657039 - 0.1588423 * ratio)) +
                                roughness * (7.001456 - 1.967016 * ratio * ratio +
                                             roughness * (0.5317459 * ratio - 6.210062 + 2.000493 * roughness)));
    return vec2(ggxMeanAlbedo(likeIsotropic(alpha.x, ratio)).x * (1.0 + (1.0 - ratio) * change),
                0.04013285 + alpha.y * (0.002212934 * alpha.y - 0.04291694) +
                    alpha.x * (-0.04294941 + 0.02613824 * alpha.y + 0.01336527 * alpha.x));
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
