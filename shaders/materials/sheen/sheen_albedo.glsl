// The directional albedo of the sheen lobe in closed form. Constants and bounds come from
// benchmarks/fit_directional_albedo.py, which checks them in single precision against quadrature. The fit errs on the
// high side, so that what the base has adds no light.
#include "bsdf/albedo.glsl"
#include "bsdf/constants.glsl"

// 0.07². Below alpha = 0.068 the lobe of KHR_materials_sheen reflects more than it receives near grazing, up to 2.94
// times as much at this alpha. Where n·v is below 6e-6 it does so at any alpha. Divided by max(1, E(v), E(l)), the lobe
// makes no light and stays reciprocal.
const float kMinSheenAlpha = 0.0049;

// 1 / (n·v (1 + sheenLambda())), accurate to 0.4% near grazing and to 4% elsewhere. sheenLambda() is the exponential of
// a number up to 17, which multiplies rounding errors by as much, and 1 - E would show them. The terms of a sum here
// are at most 3 times the sum in all.
float sheenMasking(float nDotV, float alpha) {
    float t = (1.0 - alpha) * (1.0 - alpha);
    float s = sqrt(nDotV);
    float passed = 5.1721e-5 + t * (-3.512091e-5 + t * 7.71955e-6) +
                   s * (0.035709 + t * (-0.001105202 - t * 0.0007590171)) +
                   nDotV * (1.893194 - 0.2745735 * t * t - s * 0.9185193 +
                            nDotV * (0.2681043 * t + nDotV * (0.1434749 + 0.04173563 * t)));
    float all = -2.016418e-6 + t * (8.658045e-7 + t * 5.361717e-8) +
                s * (0.03863219 + t * (0.0403013 + t * 0.01106263)) +
                nDotV * (1.0 + t * (0.8363577 + t * 0.405341) + s * 0.1633596 +
                         nDotV * t * (-0.4704616 + nDotV * (-0.4860368 - t * 0.2978368)));
    return passed / all;
}

// The share of its largest density that the lobe's NDF has at the most oblique facet which shows the view light above
// the horizon: ((1 + sin) / 2)^(1 / (2 alpha)). Near the normal such facets lie all around, and the mean over them
// depends on sin², so sin² / (sin + 4 alpha) stands in for the sine. The logarithm is the series of the hyperbolic arc
// tangent, whose last constant stands for the rest; no sum in it is a difference.
float sheenHorizon(float nDotV, float alpha) {
    float sine = sqrt((1.0 - nDotV) * (1.0 + nDotV));
    float missing = (sine * nDotV * nDotV / (1.0 + sine) + 4.0 * alpha) / (sine + 4.0 * alpha);
    float z = missing / (4.0 - missing);
    float z2 = z * z;
    return exp2(-z * (1.442695 + z2 * (0.4808984 + 0.32 * z2)) / alpha);
}

// Albedo of the white sheen lobe, alpha in [kMinSheenAlpha, 1]. It exceeds the truth by at most 2% and 2e-5, and by at
// most 1e-2 max(1, truth); it falls short by at most 2e-4 max(1, truth). It exceeds 1 where the lobe does. Single
// precision is off by at most 9e-7 max(1, truth).
float sheenAlbedo(float nDotV, float alpha) {
    float x = clamp(nDotV, kMinViewCosine, 1.0);
    alpha = forDirection(alpha, nDotV);
    float a2 = alpha * alpha;
    float r = sqrt(alpha);
    // The masking of the view is the lobe's own. The fractions stand for the light's masking and the azimuths.
    float lit = r * (0.6068648 + 0.02986767 * alpha * r) +
                x * (-0.08529104 + r * (1.026365 + 0.3330232 * r) + 2.570138 * a2 +
                     x * (0.1037437 * x * x - 1.681584 * r - 1.203383 * a2));
    float all = r * (0.0002043648 + r * (0.5531853 - 0.02827543 * r +
                                         alpha * (1.820133 - 2.673798 * r + 1.100519 * alpha))) +
                sqrt(x) * r * (0.01734508 + 0.07024139 * r) +
                x * (-0.001968605 + r * (1.0 + r * (2.651909 + r * (0.7669771 + 3.290333 * alpha))) +
                     x * (0.4671655 + r * (-3.454329 + r * (3.030931 - 1.455809 * r)) +
                          x * (2.700431 + alpha * (1.63113 - 2.39054 * r) +
                               x * (-2.811076 - 0.06855675 * r + 0.7275294 * x))));
    return sheenHorizon(x, alpha) * max(lit, 0.0) / all * sheenMasking(x, alpha);
}
