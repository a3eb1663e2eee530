#include "verify/interval.h"

#include <cmath>
#include <numbers>

namespace glint::verify {
namespace {

// Doubles have 53 bits, so products of two floats are exact, and one more operation gives the exact rounding
// error of a sum, a quotient or a root.

double divideDown(double a, double b) {
    const double quotient = a / b;
    if (!std::isfinite(quotient) || !std::isfinite(b) || quotient == 0.0) {
        // A quotient of floats is no smaller than 2^-277, so that 0 is exact here.
        return quotient;
    }
    const double rest = std::fma(-quotient, b, a);
    return (b > 0.0 ? rest < 0.0 : rest > 0.0) ? nextBelow(quotient) : quotient;
}

double rootDown(double a) {
    const double root = std::sqrt(a);
    return std::isfinite(root) && std::fma(-root, root, a) < 0.0 ? nextBelow(root) : root;
}

double rootUp(double a) {
    const double root = std::sqrt(a);
    return std::isfinite(root) && std::fma(-root, root, a) > 0.0 ? nextAbove(root) : root;
}

// A bound of the error of glibc's functions of doubles, and four times that.
constexpr double kLibraryError = 0x1p-50;

double lessLibraryError(double x) {
    return x - std::abs(x) * kLibraryError;
}

double plusLibraryError(double x) {
    return x + std::abs(x) * kLibraryError;
}

// 0 × ∞ is 0 here, because the hazard is noted and the other products matter.
double product(double a, double b) {
    return a == 0.0 || b == 0.0 ? 0.0 : a * b;
}

bool hasInfinity(const Interval& a) {
    return !a.isFinite();
}

// Returns whether one of the points offset + k period lies in the interval. Near its ends the answer may
// wrongly be yes.
bool meetsPeriod(const Interval& a, double offset, double period) {
    const double slack = 1e-14 * (a.magnitude() + std::abs(offset) + period);
    const double first = std::ceil((a.low - slack - offset) / period);
    return offset + first * period <= a.high + slack;
}

Interval cosineRange(const Interval& a) {
    constexpr double kTurn = 2.0 * std::numbers::pi;
    // Beyond this doubles do not know the phase well enough.
    if (!a.isFinite() || a.width() >= kTurn || a.magnitude() > 1e9) {
        return {-1.0, 1.0};
    }
    const double atLow = std::cos(a.low);
    const double atHigh = std::cos(a.high);
    Interval range{std::min(atLow, atHigh), std::max(atLow, atHigh)};
    if (meetsPeriod(a, 0.0, kTurn)) {
        range.high = 1.0;
    }
    if (meetsPeriod(a, std::numbers::pi, kTurn)) {
        range.low = -1.0;
    }
    return range;
}

Interval sineRange(const Interval& a) {
    constexpr double kTurn = 2.0 * std::numbers::pi;
    if (!a.isFinite() || a.width() >= kTurn || a.magnitude() > 1e9) {
        return {-1.0, 1.0};
    }
    const double atLow = std::sin(a.low);
    const double atHigh = std::sin(a.high);
    Interval range{std::min(atLow, atHigh), std::max(atLow, atHigh)};
    if (meetsPeriod(a, 0.5 * std::numbers::pi, kTurn)) {
        range.high = 1.0;
    }
    if (meetsPeriod(a, -0.5 * std::numbers::pi, kTurn)) {
        range.low = -1.0;
    }
    return range;
}

Interval rangeOfMonotone(double (*function)(double), const Interval& a) {
    return {function(a.low), function(a.high)};
}

}  // namespace

// Rounds the exact bounds outward.
Interval Arithmetic::rounded(double low, double high, Hazard& hazard) const {
    const Interval result{roundDown(low, format_), roundUp(high, format_)};
    if (!result.isFinite()) {
        hazard |= Hazard::Overflow;
    }
    return result;
}

// Rounds bounds outward that a function of the C library gave, and adds its error in the format.
Interval Arithmetic::widened(double low, double high, Hazard& hazard) const {
    const auto further = [this](double value) {
        const double unit =
            std::max(std::abs(value) * 2.0 * unitRoundoff(format_), 2.0 * halfDenormal(format_));
        return 2.0 * unit;
    };
    low = lessLibraryError(low);
    high = plusLibraryError(high);
    return rounded(low - further(low), high + further(high), hazard);
}

Interval Arithmetic::add(const Interval& a, const Interval& b, Hazard& hazard) const {
    const bool mixed =
        (a.low == -kInfinity && b.high == kInfinity) || (a.high == kInfinity && b.low == -kInfinity);
    if (mixed) {
        hazard |= Hazard::IndefiniteForm;
        return {};
    }
    return rounded(addDown(a.low, b.low), addUp(a.high, b.high), hazard);
}

Interval Arithmetic::subtract(const Interval& a, const Interval& b, Hazard& hazard) const {
    return add(a, {-b.high, -b.low}, hazard);
}

Interval Arithmetic::multiply(const Interval& a, const Interval& b, Hazard& hazard) const {
    if ((hasInfinity(a) && b.contains(0.0)) || (hasInfinity(b) && a.contains(0.0))) {
        hazard |= Hazard::IndefiniteForm;
    }
    const double products[] = {product(a.low, b.low), product(a.low, b.high), product(a.high, b.low),
                               product(a.high, b.high)};
    return rounded(std::min({products[0], products[1], products[2], products[3]}),
                   std::max({products[0], products[1], products[2], products[3]}), hazard);
}

Interval Arithmetic::square(const Interval& a, Hazard& hazard) const {
    const double least = a.contains(0.0) ? 0.0 : std::min(std::abs(a.low), std::abs(a.high));
    return rounded(product(least, least), product(a.magnitude(), a.magnitude()), hazard);
}

Interval Arithmetic::divide(const Interval& a, const Interval& b, Hazard& hazard) const {
    if (hasInfinity(a) && hasInfinity(b)) {
        hazard |= Hazard::IndefiniteForm;
        return {};
    }
    if (b.contains(0.0)) {
        hazard |= Hazard::DivisionByZero;
        // The quotients of the other divisors, if all of them have one sign.
        if (b.low == 0.0 && b.high > 0.0 && a.low >= 0.0) {
            return {roundDown(divideDown(a.low, b.high), format_), kInfinity};
        }
        if (b.low == 0.0 && b.high > 0.0 && a.high <= 0.0) {
            return {-kInfinity, roundUp(-divideDown(-a.high, b.high), format_)};
        }
        return {};
    }
    const auto down = [](double x, double y) { return x == 0.0 ? 0.0 : divideDown(x, y); };
    const auto up = [](double x, double y) { return x == 0.0 ? 0.0 : -divideDown(-x, y); };
    return rounded(
        std::min({down(a.low, b.low), down(a.low, b.high), down(a.high, b.low), down(a.high, b.high)}),
        std::max({up(a.low, b.low), up(a.low, b.high), up(a.high, b.low), up(a.high, b.high)}), hazard);
}

Interval Arithmetic::root(Function function, Interval a, Hazard& hazard) const {
    if (a.low < 0.0) {
        hazard |= Hazard::RootOfNegative;
        a = {0.0, std::max(a.high, 0.0)};
    }
    const double low = rootDown(a.low);
    const double high = rootUp(a.high);
    if (function == Function::Sqrt) {
        return rounded(low, high, hazard);
    }
    if (a.low == 0.0) {
        hazard |= Hazard::DivisionByZero;
        return {high == 0.0 ? 0.0 : roundDown(1.0 / high, format_), kInfinity};
    }
    return widened(1.0 / high, 1.0 / low, hazard);
}

Interval Arithmetic::apply(Function function, const Interval& given, Hazard& hazard) const {
    Interval a = given;
    switch (function) {
        case Function::Sqrt:
        case Function::InverseSqrt:
            return root(function, a, hazard);
        case Function::Log:
        case Function::Log2: {
            if (a.low <= 0.0) {
                hazard |= Hazard::LogOfNonPositive;
                a.low = 0.0;
                a.high = std::max(a.high, 0.0);
            }
            double (*const log)(double) = function == Function::Log
                                              ? static_cast<double (*)(double)>(std::log)
                                              : static_cast<double (*)(double)>(std::log2);
            if (a.low == 0.0) {
                Hazard ignored = Hazard::None;
                return {-kInfinity, widened(0.0, log(a.high), ignored).high};
            }
            return widened(log(a.low), log(a.high), hazard);
        }
        case Function::Exp:
        case Function::Exp2: {
            double (*const exp)(double) = function == Function::Exp
                                              ? static_cast<double (*)(double)>(std::exp)
                                              : static_cast<double (*)(double)>(std::exp2);
            Interval result = widened(exp(a.low), exp(a.high), hazard);
            result.low = std::max(result.low, 0.0);
            return result;
        }
        case Function::Sin:
        case Function::Cos: {
            if (!a.isFinite()) {
                hazard |= Hazard::IndefiniteForm;
            }
            const Interval range = function == Function::Sin ? sineRange(a) : cosineRange(a);
            // The argument's own rounding counts near the ends of the domain of doubles only.
            return meet(
                widened(range.low - 1e-15 * a.magnitude(), range.high + 1e-15 * a.magnitude(), hazard),
                {-1.0, 1.0});
        }
        case Function::Tan: {
            if (a.width() >= 3.0 || !a.isFinite() ||
                meetsPeriod(a, 0.5 * std::numbers::pi, std::numbers::pi)) {
                hazard |= Hazard::Overflow;
                return {};
            }
            return widened(std::tan(a.low), std::tan(a.high), hazard);
        }
        case Function::Asin:
        case Function::Acos: {
            if (a.low < -1.0 || a.high > 1.0) {
                hazard |= Hazard::ArcBeyondOne;
                a = meet(a, {-1.0, 1.0});
                if (a.isEmpty()) {
                    return {};
                }
            }
            return function == Function::Asin ? widened(std::asin(a.low), std::asin(a.high), hazard)
                                              : widened(std::acos(a.high), std::acos(a.low), hazard);
        }
        case Function::Atan: {
            const Interval range = rangeOfMonotone(std::atan, a);
            return widened(range.low, range.high, hazard);
        }
    }
    return {};
}

Interval Arithmetic::power(const Interval& given, const Interval& b, Hazard& hazard) const {
    Interval a = given;
    if (a.low < 0.0) {
        hazard |= Hazard::PowerOfNegative;
        a = {0.0, std::max(a.high, 0.0)};
    }
    if (a.low == 0.0 && b.low <= 0.0) {
        hazard |= Hazard::PowerOfNegative;
        return {0.0, kInfinity};
    }
    const auto at = [](double x, double y) {
        return x == 0.0 ? (y > 0.0 ? 0.0 : kInfinity) : std::pow(x, y);
    };
    const double corners[] = {at(a.low, b.low), at(a.low, b.high), at(a.high, b.low), at(a.high, b.high)};
    Interval result = widened(std::min({corners[0], corners[1], corners[2], corners[3]}),
                              std::max({corners[0], corners[1], corners[2], corners[3]}), hazard);
    result.low = std::max(result.low, 0.0);
    return result;
}

Interval Arithmetic::arcTangent(const Interval& y, const Interval& x, Hazard& hazard) const {
    if (y.contains(0.0) && x.contains(0.0)) {
        hazard |= Hazard::ArcOfOrigin;
    }
    if (y.contains(0.0) && x.low <= 0.0) {
        return widened(-std::numbers::pi, std::numbers::pi, hazard);
    }
    // The angle has no extremum within a box that the cut does not meet.
    const double corners[] = {std::atan2(y.low, x.low), std::atan2(y.low, x.high), std::atan2(y.high, x.low),
                              std::atan2(y.high, x.high)};
    return widened(std::min({corners[0], corners[1], corners[2], corners[3]}),
                   std::max({corners[0], corners[1], corners[2], corners[3]}), hazard);
}

Interval Arithmetic::mix(const Interval& x, const Interval& y, const Interval& t, Hazard& hazard) const {
    if (!x.isFinite() || !y.isFinite() || !t.isFinite()) {
        hazard |= Hazard::Overflow;
        return {};
    }
    // The function is linear in each argument, so its extrema are at corners.
    Interval range = Interval::nothing();
    for (const double a : {x.low, x.high}) {
        for (const double b : {y.low, y.high}) {
            for (const double s : {t.low, t.high}) {
                const double value = a * (1.0 - s) + b * s;
                range = hull(range, Interval::of(value));
            }
        }
    }
    // Four roundings of terms that are no larger than this.
    const double terms = (x.magnitude() + y.magnitude()) * (1.0 + 2.0 * t.magnitude());
    const double error = terms * 4.0 * unitRoundoff(format_) + 8.0 * halfDenormal(format_);
    Interval result = rounded(range.low - error, range.high + error, hazard);
    // Without a change of sign, rounding keeps the sign of x (1 - t) + y t for shares t.
    if (t.low >= 0.0 && t.high <= 1.0 && x.low >= 0.0 && y.low >= 0.0) {
        result.low = std::max(result.low, 0.0);
    }
    return result;
}

Interval Arithmetic::normalized(const Interval& x, const Interval& rest) const {
    const auto at = [](double value, double other2) {
        return value == 0.0 ? 0.0 : value / std::sqrt(value * value + std::max(other2, 0.0));
    };
    const double low = at(x.low, x.low > 0.0 ? rest.high : rest.low);
    const double high = at(x.high, x.high > 0.0 ? rest.low : rest.high);
    // The sum of squares, its root and the quotient: some five roundings.
    const double error = 6.0 * unitRoundoff(format_);
    Hazard ignored = Hazard::None;
    return rounded(low - std::abs(low) * error - 4.0 * halfDenormal(format_),
                   high + std::abs(high) * error + 4.0 * halfDenormal(format_), ignored);
}

Interval Arithmetic::convert(const Interval& a, Hazard& hazard) const {
    return rounded(a.low, a.high, hazard);
}

}  // namespace glint::verify
