#include "image/flip_color.h"

#include <algorithm>
#include <cmath>

namespace glint::image::flip {

namespace {

using Matrix = std::array<Color, 3>;

// Matrices from linear RGB to CIE XYZ and back, derived from the chromaticities of ITU-R BT.709's primaries
// and of D65 (0.3127, 0.3290).
constexpr Matrix kToXyz{{{506752.0 / 1228815.0, 87881.0 / 245763.0, 12673.0 / 70218.0},
                         {87098.0 / 409605.0, 175762.0 / 245763.0, 12673.0 / 175545.0},
                         {7918.0 / 409605.0, 87881.0 / 737289.0, 1001167.0 / 1053270.0}}};
constexpr Matrix kFromXyz{{{12831.0 / 3959.0, -329.0 / 214.0, -1974.0 / 3959.0},
                           {-851781.0 / 878810.0, 1648619.0 / 878810.0, 36519.0 / 878810.0},
                           {705.0 / 12673.0, -2585.0 / 12673.0, 705.0 / 667.0}}};

// White in XYZ, which is the reference illuminant.
constexpr Color kWhite{kToXyz[0][0] + kToXyz[0][1] + kToXyz[0][2], kToXyz[1][0] + kToXyz[1][1] + kToXyz[1][2],
                       kToXyz[2][0] + kToXyz[2][1] + kToXyz[2][2]};

// q_c, p_c and p_t of the paper: the exponent of the difference, and the bend of its range. Differences up to
// kBend of the largest one take kBendTo of the output.
constexpr double kExponent = 0.7;
constexpr double kBend = 0.4;
constexpr double kBendTo = 0.95;

constexpr Color multiply(const Matrix& m, const Color& v) {
    return {m[0][0] * v[0] + m[0][1] * v[1] + m[0][2] * v[2],
            m[1][0] * v[0] + m[1][1] * v[1] + m[1][2] * v[2],
            m[2][0] * v[0] + m[2][1] * v[1] + m[2][2] * v[2]};
}

// The function f of CIE 1976 L*a*b* (CIE 15:2004).
double labCurve(double t) {
    constexpr double kDelta = 6.0 / 29.0;
    return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3.0 * kDelta * kDelta) + 4.0 / 29.0;
}

// The HyAB distance: Abasi, Amani Tehran and Fairchild 2019, "Distance metrics for very large color
// differences".
double hyab(const Color& a, const Color& b) {
    return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

}  // namespace

// Source: Flohr, Kolpatzik, Balasubramanian, Carrara, Bouman and Allebach 1993, "Model-based color image
// quantization".
Color toOpponent(const Color& rgb) {
    const Color xyz = multiply(kToXyz, rgb);
    const double x = xyz[0] / kWhite[0];
    const double y = xyz[1] / kWhite[1];
    const double z = xyz[2] / kWhite[2];
    return {116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)};
}

Color fromOpponent(const Color& opponent) {
    const double y = (opponent[0] + 16.0) / 116.0;
    const double x = y + opponent[1] / 500.0;
    const double z = y - opponent[2] / 200.0;
    return multiply(kFromXyz, {x * kWhite[0], y * kWhite[1], z * kWhite[2]});
}

// Sources: CIE 1976 L*a*b* (CIE 15:2004), and Hunt 1952, "Light and Dark Adaptation and the Perception of
// Color", in the form of the paper.
Color toHuntLab(const Color& rgb) {
    const Color xyz = multiply(kToXyz, rgb);
    const double x = labCurve(xyz[0] / kWhite[0]);
    const double y = labCurve(xyz[1] / kWhite[1]);
    const double z = labCurve(xyz[2] / kWhite[2]);
    const double lightness = 116.0 * y - 16.0;
    return {lightness, 0.01 * lightness * 500.0 * (x - y), 0.01 * lightness * 200.0 * (y - z)};
}

double colorDifference(const Color& a, const Color& b) {
    // The largest difference within Rec. 709 is that between green and blue.
    static const double kLargest =
        std::pow(hyab(toHuntLab({0.0, 1.0, 0.0}), toHuntLab({0.0, 0.0, 1.0})), kExponent);
    const double difference = std::pow(hyab(a, b), kExponent);
    const double bend = kBend * kLargest;
    if (difference < bend) {
        return kBendTo / bend * difference;
    }
    return std::min(1.0, kBendTo + (difference - bend) / (kLargest - bend) * (1.0 - kBendTo));
}

}  // namespace glint::image::flip
