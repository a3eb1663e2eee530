#include "verify/affine.h"

#include <algorithm>
#include <cmath>

namespace glint::verify {
namespace {

// A bound of the rounding error of the doubles in an operation on forms, relative to the size of its numbers.
constexpr double kSlack = 0x1p-46;

void finish(Affine& result, double terms) {
    result.error = result.error * (1.0 + kSlack) + kSlack * terms + std::numeric_limits<double>::min();
    result.isValid = std::isfinite(result.center) && std::isfinite(result.error);
}

// slope × a + offset ± error
void line(const Affine& a, double slope, double offset, double error, Affine& result) {
    for (std::size_t d = 0; d < result.slopes.size(); ++d) {
        result.slopes[d] = slope * a.slopes[d];
    }
    const double size = std::abs(slope) * (std::abs(a.center) + a.radius()) + std::abs(offset);
    result.center = slope * a.center + offset;
    result.error = std::abs(slope) * a.error + error;
    finish(result, size);
}

// Encloses a convex (or, with sign -1, concave) function between its secant over [low, high] and a parallel
// line below. `touch` is where the derivative is about the secant's slope, and `derivative` the derivative
// there.
void chord(const Affine& a, double low, double high, double atLow, double atHigh, double touch,
           double atTouch, double derivative, double slope, double valueError, Affine& result) {
    const double width = high - low;
    const double secantLow = atLow - slope * low;
    const double secantHigh = atHigh - slope * high;
    const double touching = atTouch - slope * touch;
    // The difference between the derivative at `touch` and the slope lowers the parallel line.
    const double miss = std::abs(derivative - slope) * width;
    const double least = std::min({secantLow, secantHigh, touching}) - miss;
    const double greatest = std::max({secantLow, secantHigh, touching}) + miss;
    const double size =
        std::abs(atLow) + std::abs(atHigh) + std::abs(slope) * (std::abs(low) + std::abs(high));
    line(a, slope, 0.5 * (least + greatest),
         0.5 * (greatest - least) + valueError * (std::abs(atLow) + std::abs(atHigh) + std::abs(atTouch)) +
             kSlack * size,
         result);
}

// A generous bound of the error of glibc's functions of doubles.
constexpr double kFunctionError = 0x1p-48;

}  // namespace

double Affine::radius() const {
    double sum = error;
    for (const double slope : slopes) {
        sum += std::abs(slope);
    }
    return sum * (1.0 + kSlack);
}

Interval Affine::range() const {
    const double reach = radius();
    const double slack = std::abs(center) * 0x1p-52;
    return {center - reach - slack, center + reach + slack};
}

void Affine::set(const Interval& value) {
    std::fill(slopes.begin(), slopes.end(), 0.0);
    center = 0.5 * value.low + 0.5 * value.high;
    error = std::max(value.high - center, center - value.low) * (1.0 + 0x1p-50);
    isValid = value.isFinite() && !value.isEmpty();
}

void addAffine(const Affine& a, const Affine& b, double signOfB, Affine& result) {
    if (!a.isValid || !b.isValid) {
        result.isValid = false;
        return;
    }
    double size = std::abs(a.center) + std::abs(b.center);
    for (std::size_t d = 0; d < result.slopes.size(); ++d) {
        size += std::abs(a.slopes[d]) + std::abs(b.slopes[d]);
        result.slopes[d] = a.slopes[d] + signOfB * b.slopes[d];
    }
    result.center = a.center + signOfB * b.center;
    result.error = a.error + b.error;
    finish(result, size * 0x1p-5);  // each sum rounds once
}

void multiplyAffine(const Affine& a, const Affine& b, Affine& result) {
    if (!a.isValid || !b.isValid) {
        result.isValid = false;
        return;
    }
    const double radiusA = a.radius();
    const double radiusB = b.radius();
    const double size = (std::abs(a.center) + radiusA) * (std::abs(b.center) + radiusB);
    const double center = a.center * b.center;
    const double error = std::abs(a.center) * b.error + std::abs(b.center) * a.error + radiusA * radiusB;
    for (std::size_t d = 0; d < result.slopes.size(); ++d) {
        result.slopes[d] = a.center * b.slopes[d] + b.center * a.slopes[d];
    }
    result.center = center;
    result.error = error;
    finish(result, size);
}

void squareAffine(const Affine& a, Affine& result) {
    if (!a.isValid) {
        result.isValid = false;
        return;
    }
    const double radius = a.radius();
    const double size = (std::abs(a.center) + radius) * (std::abs(a.center) + radius);
    const double center = a.center;
    for (std::size_t d = 0; d < result.slopes.size(); ++d) {
        result.slopes[d] = 2.0 * center * a.slopes[d];
    }
    // The square of the deviation is in [0, radius²].
    result.center = center * center + 0.5 * radius * radius;
    result.error = 2.0 * std::abs(center) * a.error + 0.5 * radius * radius;
    finish(result, size);
}

void scaleAffine(const Affine& a, double factor, Affine& result) {
    if (!a.isValid) {
        result.isValid = false;
        return;
    }
    line(a, factor, 0.0, 0.0, result);
}

void copyAffine(const Affine& a, Affine& result) {
    result.isValid = a.isValid;
    result.center = a.center;
    result.error = a.error;
    std::copy(a.slopes.begin(), a.slopes.end(), result.slopes.begin());
}

void divideAffine(const Affine& a, const Affine& b, const Interval& y, std::span<double> scratch,
                  Affine& result) {
    result.isValid = false;
    if (!a.isValid || !b.isValid || y.contains(0.0) || !y.isFinite()) {
        return;
    }
    // 1 / y is convex for y > 0 and concave for y < 0.
    const double atLow = 1.0 / y.low;
    const double atHigh = 1.0 / y.high;
    const double slope = y.isPoint() ? 0.0 : -atLow * atHigh;
    const double touch = std::copysign(std::sqrt(y.low * y.high), y.low);
    Affine inverse;
    inverse.slopes = scratch;
    chord(b, y.low, y.high, atLow, atHigh, touch, 1.0 / touch, -1.0 / (touch * touch), slope, 0x1p-51,
          inverse);
    multiplyAffine(a, inverse, result);
}

void applyAffine(Function function, const Affine& a, const Interval& x, Affine& result) {
    result.isValid = false;
    if (!a.isValid || !x.isFinite()) {
        return;
    }
    const double low = x.low;
    const double high = x.high;
    const double width = high - low;
    const auto secant = [&](double atLow, double atHigh) {
        return width > 0.0 ? (atHigh - atLow) / width : 0.0;
    };
    switch (function) {
        case Function::Sqrt: {
            if (low < 0.0) {
                return;
            }
            const double atLow = std::sqrt(low);
            const double atHigh = std::sqrt(high);
            const double sum = atLow + atHigh;
            if (sum == 0.0) {
                return;
            }
            const double slope = 1.0 / sum;
            const double touch = 0.25 * sum * sum;
            chord(a, low, high, atLow, atHigh, touch, 0.5 * sum, 1.0 / sum, slope, 0x1p-51, result);
            return;
        }
        case Function::InverseSqrt: {
            if (low <= 0.0) {
                return;
            }
            const double atLow = 1.0 / std::sqrt(low);
            const double atHigh = 1.0 / std::sqrt(high);
            const double slope = secant(atLow, atHigh);
            const double touch =
                slope < 0.0 ? std::clamp(std::pow(-2.0 * slope, -2.0 / 3.0), low, high) : low;
            const double atTouch = 1.0 / std::sqrt(touch);
            chord(a, low, high, atLow, atHigh, touch, atTouch, -0.5 * atTouch / touch, slope, 0x1p-49,
                  result);
            return;
        }
        case Function::Exp:
        case Function::Exp2: {
            const double scale = function == Function::Exp ? 1.0 : 0.6931471805599453;
            const double atLow = std::exp(scale * low);
            const double atHigh = std::exp(scale * high);
            const double slope = secant(atLow, atHigh);
            const double touch = slope > 0.0 ? std::clamp(std::log(slope / scale) / scale, low, high) : low;
            const double atTouch = std::exp(scale * touch);
            chord(a, low, high, atLow, atHigh, touch, atTouch, scale * atTouch, slope,
                  kFunctionError * (1.0 + x.magnitude()), result);
            return;
        }
        case Function::Log:
        case Function::Log2: {
            if (low <= 0.0) {
                return;
            }
            const double scale = function == Function::Log ? 1.0 : 1.4426950408889634;
            const double atLow = scale * std::log(low);
            const double atHigh = scale * std::log(high);
            const double slope = secant(atLow, atHigh);
            const double touch = slope > 0.0 ? std::clamp(scale / slope, low, high) : low;
            chord(a, low, high, atLow, atHigh, touch, scale * std::log(touch), scale / touch, slope,
                  kFunctionError, result);
            return;
        }
        default:
            return;
    }
}

void powerAffine(const Affine& a, const Interval& x, double exponent, Affine& result) {
    result.isValid = false;
    if (!a.isValid || x.low <= 0.0 || !x.isFinite()) {
        return;
    }
    const double atLow = std::pow(x.low, exponent);
    const double atHigh = std::pow(x.high, exponent);
    const double slope = x.isPoint() ? 0.0 : (atHigh - atLow) / x.width();
    const double ratio = slope / exponent;
    const double touch = ratio > 0.0 && exponent != 1.0
                             ? std::clamp(std::pow(ratio, 1.0 / (exponent - 1.0)), x.low, x.high)
                             : x.low;
    const double atTouch = std::pow(touch, exponent);
    chord(a, x.low, x.high, atLow, atHigh, touch, atTouch, exponent * atTouch / touch, slope, kFunctionError,
          result);
}

void maximumAffine(const Affine& a, const Affine& b, double sign, std::span<double> scratch, Affine& result) {
    result.isValid = false;
    if (!a.isValid || !b.isValid) {
        return;
    }
    // max(a, b) = b + max(a - b, 0), and min(a, b) = b - max(b - a, 0).
    Affine difference;
    difference.slopes = scratch;
    addAffine(a, b, -1.0, difference);
    if (!difference.isValid) {
        return;
    }
    const Interval d =
        sign > 0.0 ? difference.range() : Interval{-difference.range().high, -difference.range().low};
    if (d.low >= 0.0) {
        copyAffine(a, result);
        return;
    }
    if (d.high <= 0.0) {
        copyAffine(b, result);
        return;
    }
    // max(d, 0) lies between its secant, slope d + 0.5 error ± 0.5 error, and the kink.
    const double slope = d.high / (d.high - d.low);
    const double rise = -slope * d.low;
    for (std::size_t k = 0; k < result.slopes.size(); ++k) {
        result.slopes[k] = b.slopes[k] + slope * difference.slopes[k];
    }
    const double size = std::abs(b.center) + b.radius() + std::abs(difference.center) + difference.radius();
    // The sign of min's correction: b - max(b - a, 0) = b + min(a - b, 0), and slope (a - b) - rise / 2
    // there.
    result.center = b.center + slope * difference.center + sign * 0.5 * rise;
    result.error = b.error + slope * difference.error + 0.5 * rise;
    finish(result, size);
}

void roundAffine(Affine& result, Format format, double furtherUnits) {
    if (!result.isValid) {
        return;
    }
    const double size = std::abs(result.center) + result.radius();
    const double unit = unitRoundoff(format);
    // Rounding to either neighbour, as on intervals, is one unit; a unit is at most twice the roundoff of the
    // value.
    result.error += 2.0 * (1.0 + furtherUnits) * (unit * size + halfDenormal(format));
    result.isValid = std::isfinite(result.error);
}

}  // namespace glint::verify
