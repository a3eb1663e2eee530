// Directional albedos in closed form: the share of a uniform white sky that a lobe reflects. Constants and bounds come
// from benchmarks/fit_directional_albedo.py, which checks them in single precision against quadrature. The fits err on
// the high side, so that the terms that take the rest add no light.
#include "bsdf/constants.glsl"

// Returns alpha. Compilers do not see that it is the same for all directions, so they compute what follows from it for
// each of them. Otherwise they keep up to 20 coefficients of the fits below in registers from one light to the next.
// The sign of a cosine above 0 changes nothing; that of another changes the last digit. Proofs know intervals of floats
// and not their bits, and their cosines are above 0.
float forDirection(float alpha, float cosine) {
#ifdef GLINT_PROVES
    return alpha;
#else
    return uintBitsToFloat(floatBitsToUint(alpha) | floatBitsToUint(cosine) >> 31);
#endif
}

// The share that white microfacets lose by single scattering: ggxAlbedo().x.
float ggxLoss(float nDotV, float alpha) {
    float a = forDirection(alpha, nDotV);
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
    float a = forDirection(alpha, nDotV);
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
// y, is 0.9997 to 1.005 times its integral, for all f0 <= f90 <= 1. The logarithm comes from the tail of the loss,
// alpha² / n·v².
vec2 ggxMeanAlbedo(float alpha) {
    float a2 = alpha * alpha;
    float loss = 0.2189529 + a2 * (34.89501 * alpha - 34.52422) -
                 log2(alpha) * (0.7132721 + alpha * (alpha * (13.40621 + 11.68229 * alpha) - 0.5533438));
    float roughness = sqrt(alpha);
    float bias = 0.04699041 + roughness * (0.03384517 + roughness * (-0.3704664 + roughness * (0.5095749 -
                 0.2168147 * roughness)));
    return vec2(a2 * loss, bias);
}

// The alpha of the isotropic lobe that loses about as much as an anisotropic one.
float likeIsotropic(float larger, float ratio) {
    return larger * (1.0 - 0.22 * (1.0 - ratio) * sqrt(larger));
}

// ggxAlbedo() of an anisotropic lobe, alpha.x >= alpha.y. Between grooves along y, no facet changes the part of a
// direction along them, so the loss depends on the rest of the view alone. The fit knows the view with this part
// shortened by the ratio of the alphas, and is ggxAlbedo() if they are equal. E exceeds the truth by at most 1e-2, below
// a cosine of 0.04 by at most 1.8e-2, and falls short by at most 3e-3. y exceeds the truth by at most 6e-2 and falls
// short by at most 7e-3, both for oblique views of strong anisotropy.
vec2 anisotropicGgxAlbedo(vec3 v, vec2 alpha) {
    alpha = vec2(forDirection(alpha.x, v.z), forDirection(alpha.y, v.z));
    float larger = alpha.x;
    float ratio = alpha.y / alpha.x;
    float shortened = ratio * v.y;
    float size = sqrt(v.z * v.z + v.x * v.x + shortened * shortened);
    float cosine = v.z / size;
    float along2 = v.x * v.x / (size * size);
    float change =
        -0.07129767 + 0.08130389 * along2 * along2 + larger * (along2 * (-1.076848 -
        0.2940859 * along2 * along2) + larger * (-0.5439288 + 1.65534 * along2 + larger * (0.7614213 -
        0.6125532 * along2 - 0.2975765 * larger))) + ratio * (along2 * (0.5611683 - 0.5718784 * along2) +
        larger * (-0.3020957 - 1.392543 * along2 + 1.145875 * larger * along2) + ratio * (along2 * (-1.093594 +
        1.193578 * along2))) + cosine * (0.9123158 - 0.01780192 * along2 * along2 * along2 +
        larger * larger * (-0.3598492 + 0.3408334 * along2) + 0.9035594 * ratio * ratio * along2 +
        cosine * (-2.775457 + larger * (0.7769664 - 0.7840454 * along2) + ratio * (-1.220514 + 0.7470105 * larger +
        0.3480447 * ratio) + cosine * (2.988206 + 0.3926723 * ratio - 1.54729 * cosine)));
    float loss = ggxLoss(cosine, likeIsotropic(larger, ratio)) * (1.0 + (1.0 - ratio) * change);
    // The alpha along the view.
    vec2 slope = alpha * v.xy;
    float a = clamp(sqrt(dot(slope, slope) / max(dot(v.xy, v.xy), 1e-12)), kMinAlpha, 1.0);
    float shift = ggxShift(v.z, a);
    float further =
        -0.7044803 - 1.062169 * a + 2.208309 * ratio + size * (2.280829 + 2.003423 * a -
        8.326199 * ratio + size * (-2.091328 - 0.843733 * a + 6.308936 * ratio + 0.3956468 * size)) +
        cosine * (-0.1642611 - 0.7560449 * a * a + ratio * (1.872618 + 1.079922 * ratio) + size * (-2.069043 * a -
        5.063027 * ratio + 1.287943 * size) + cosine * (-0.3774205 - 0.376236 * size));
    shift += (1.0 - ratio) * (shift * further - 0.1069687 * larger * v.z * cosine);
    return albedoAt(loss, v.z + shift);
}

// ggxMeanAlbedo() of exactly this fit, over all azimuths: the integral of the loss is 0.995 to 1.0003 times its x, but
// for 4e-5 of a small loss. The fit of the bias falls to -1e-3 where both alphas are about 0.8; no share is negative.
vec2 anisotropicGgxMeanAlbedo(vec2 alpha) {
    float ratio = alpha.y / alpha.x;
    float roughness = sqrt(alpha.x);
    float change =
        -0.3274147 + ratio * (-0.4135516 + ratio * (-0.3130759 + ratio * (0.441129 +
        ratio * (-0.2336199 + 0.03670227 * ratio)))) + roughness * (-0.6699184 + ratio * (-0.6234454 +
        ratio * (3.093386 + ratio * (-1.963356 + 0.4824332 * ratio))) + roughness * (1.644908 + ratio * (1.095875 +
        ratio * (-2.621545 + 0.9443727 * ratio)) + roughness * (-0.4543675 + ratio * (-1.06005 + 0.3805428 * ratio) +
        roughness * (-0.7258241 + 0.6633156 * ratio + 0.4011726 * roughness))));
    return vec2(ggxMeanAlbedo(likeIsotropic(alpha.x, ratio)).x * (1.0 + (1.0 - ratio) * change),
                max(0.04012245 + alpha.y * (-0.04584752 - 0.01377789 * alpha.y) + alpha.x * (-0.0402732 +
                    0.04390965 * alpha.y + 0.01139369 * alpha.x), 0.0));
}
