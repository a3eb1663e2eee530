#include "oracle/spec/lobes.h"

#include <algorithm>
#include <cmath>

namespace glint::spec {
namespace {

double stretched(const Vec3& v, const Vec2& alpha) {
    return glm::length(Vec3(alpha.x * v.x, alpha.y * v.y, v.z));
}

double interfaceF0(double inner, double outer) {
    return squared((inner - outer) / (inner + outer));
}

double schlick(double f0, double cosine) {
    return f0 + (1.0 - f0) * schlickWeight(cosine);
}

// evalSensitivity() of the extension's text for one order of the film's interference. The path is in
// nanometres, `shift` in radians for red, green and blue.
Vec3 sensitivity(double path, const Vec3& shift) {
    const double phase = 2.0 * kPi * path * 1.0e-9;
    const Vec3 value(5.4856e-13, 4.4201e-13, 5.2481e-13);
    const Vec3 position(1.6810e+06, 1.7953e+06, 2.2084e+06);
    const Vec3 variance(4.3278e+09, 9.3046e+09, 6.6121e+09);
    Vec3 xyz(0.0);
    for (int i = 0; i < 3; ++i) {
        xyz[i] = value[i] * std::sqrt(2.0 * kPi * variance[i]) * std::cos(position[i] * phase + shift[i]) *
                 std::exp(-phase * phase * variance[i]);
    }
    xyz.x += 9.7470e-14 * std::sqrt(2.0 * kPi * 4.5282e+09) * std::cos(2.2399e+06 * phase + shift.x) *
             std::exp(-4.5282e+09 * phase * phase);
    xyz /= 1.0685e-7;
    // XYZ_TO_REC709, whose columns the text lists.
    return Vec3(3.2404542, -0.9692660, 0.0556434) * xyz.x + Vec3(-1.5371385, 1.8760108, -0.2040259) * xyz.y +
           Vec3(-0.4985314, 0.0415560, 1.0572252) * xyz.z;
}

double sheenFit(double x, double alpha) {
    const double t = squared(1.0 - alpha);
    const double a = std::lerp(21.5473, 25.3245, t);
    const double b = std::lerp(3.82987, 3.32435, t);
    const double c = std::lerp(0.19823, 0.16801, t);
    const double d = std::lerp(-1.97760, -1.27393, t);
    const double e = std::lerp(-4.32054, -4.85967, t);
    return a / (1.0 + b * std::pow(x, c)) + d * x + e;
}

double sheenLambda(double cosine, double alpha) {
    return std::abs(cosine) < 0.5 ? std::exp(sheenFit(cosine, alpha))
                                  : std::exp(2.0 * sheenFit(0.5, alpha) - sheenFit(1.0 - cosine, alpha));
}

}  // namespace

double distribution(const Vec3& h, const Vec2& alpha) {
    if (h.z <= 0.0) {
        return 0.0;
    }
    const double both = alpha.x * alpha.y;
    const Vec3 f(alpha.y * h.x, alpha.x * h.y, both * h.z);
    const double w = both / glm::dot(f, f);
    return both * w * w / kPi;
}

double visibility(const Vec3& l, const Vec3& v, const Vec2& alpha, Masking masking) {
    const double lz = std::abs(l.z);
    const double vz = std::abs(v.z);
    if (masking == Masking::Separable) {
        return 1.0 / ((lz + stretched(l, alpha)) * (vz + stretched(v, alpha)));
    }
    return 0.5 / (lz * stretched(v, alpha) + vz * stretched(l, alpha));
}

double masking(const Vec3& v, const Vec2& alpha) {
    return 2.0 * std::abs(v.z) / (std::abs(v.z) + stretched(v, alpha));
}

double schlickWeight(double cosine) {
    return std::pow(std::max(1.0 - std::abs(cosine), 0.0), 5.0);
}

double reflectanceOfIor(double ior) {
    return interfaceF0(ior, 1.0);
}

Vec3 dispersedIors(double ior, double dispersion) {
    const double half = (ior - 1.0) * 0.025 * dispersion;
    return {ior - half, ior, ior + half};
}

Vec3 filmFresnel(double filmIor, const Vec3& baseF0, double thickness, double cosine) {
    const double sine2 = (1.0 - cosine * cosine) / (filmIor * filmIor);
    if (sine2 > 1.0) {
        return Vec3(1.0);  // total internal reflection
    }
    const double inner = std::sqrt(1.0 - sine2);
    const double r12 = schlick(interfaceF0(filmIor, 1.0), cosine);
    const double t121 = 1.0 - r12;
    const double phase21 = filmIor < 1.0 ? 0.0 : kPi;
    const double path = 2.0 * filmIor * thickness * inner;
    Vec3 reflected(0.0);
    Vec3 phase(0.0);
    Vec3 series(0.0);
    Vec3 amplitude(0.0);
    for (int i = 0; i < 3; ++i) {
        // The text adds 0.0001 as a "guard against 1.0". For an F0 above 0.9999 the sum would pass 1 and turn
        // the phase, so it ends there.
        const double root = std::sqrt(std::min(baseF0[i] + 0.0001, 0.9999));
        const double baseIor = (1.0 + root) / (1.0 - root);
        const double r23 = schlick(interfaceF0(baseIor, filmIor), inner);
        phase[i] = phase21 + (baseIor < filmIor ? kPi : 0.0);
        const double r123 = std::clamp(r12 * r23, 1e-5, 0.9999);
        amplitude[i] = std::sqrt(r123);
        series[i] = t121 * t121 * r23 / (1.0 - r123);
        reflected[i] = r12 + series[i];
    }
    Vec3 order = series - Vec3(t121);
    for (int m = 1; m <= 2; ++m) {
        order *= amplitude;
        reflected += 2.0 * order * sensitivity(m * path, static_cast<double>(m) * phase);
    }
    return glm::max(reflected, Vec3(0.0));
}

double sheenDistribution(double cosine, double alpha) {
    const double inverse = 1.0 / alpha;
    const double sine2 = std::max(1.0 - cosine * cosine, 0.0);
    return (2.0 + inverse) * std::pow(sine2, 0.5 * inverse) / (2.0 * kPi);
}

double sheenVisibility(double lightCosine, double viewCosine, double alpha) {
    return 1.0 / ((1.0 + sheenLambda(viewCosine, alpha) + sheenLambda(lightCosine, alpha)) * 4.0 *
                  viewCosine * lightCosine);
}

double largest(const Vec3& v) {
    return std::max({v.x, v.y, v.z});
}

}  // namespace glint::spec
