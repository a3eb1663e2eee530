#include "materials/interval.h"

#include <algorithm>
#include <cmath>

namespace glint::materials {

namespace {

// The product of 0 and an infinite bound is 0, because the bound itself is never reached.
double product(double a, double b) {
    return a == 0.0 || b == 0.0 ? 0.0 : a * b;
}

// Infinities of both signs can cancel in a sum, and the result is then unknown.
ValueInterval checked(double low, double high) {
    return std::isnan(low) || std::isnan(high) ? kAnything : ValueInterval{low, high};
}

template <typename Function>
ValueInterval rising(ValueInterval a, const Function& function) {
    return checked(function(a.low), function(a.high));
}

// Sines and cosines of an interval that is not exact are only known to be within their range.
template <typename Function>
ValueInterval periodic(ValueInterval a, const Function& function) {
    return a.isExact() && std::isfinite(a.low) ? rising(a, function) : ValueInterval{-1.0, 1.0};
}

}  // namespace

Certainty operator!(Certainty certainty) {
    return certainty == Certainty::Unknown ? Certainty::Unknown : certain(certainty == Certainty::False);
}

Certainty operator&&(Certainty a, Certainty b) {
    if (a == Certainty::False || b == Certainty::False) {
        return Certainty::False;
    }
    return a == Certainty::True && b == Certainty::True ? Certainty::True : Certainty::Unknown;
}

Certainty operator||(Certainty a, Certainty b) {
    return !(!a && !b);
}

ValueInterval add(ValueInterval a, ValueInterval b) {
    return checked(a.low + b.low, a.high + b.high);
}

ValueInterval subtract(ValueInterval a, ValueInterval b) {
    return checked(a.low - b.high, a.high - b.low);
}

ValueInterval multiply(ValueInterval a, ValueInterval b) {
    const auto [low, high] = std::minmax(
        {product(a.low, b.low), product(a.low, b.high), product(a.high, b.low), product(a.high, b.high)});
    return {low, high};
}

ValueInterval divide(ValueInterval a, ValueInterval b) {
    if (b.low <= 0.0 && b.high >= 0.0) {
        return kAnything;
    }
    const double quotients[] = {a.low / b.low, a.low / b.high, a.high / b.low, a.high / b.high};
    if (std::ranges::any_of(quotients, [](double quotient) { return std::isnan(quotient); })) {
        return kAnything;
    }
    return {*std::ranges::min_element(quotients), *std::ranges::max_element(quotients)};
}

ValueInterval minimum(ValueInterval a, ValueInterval b) {
    return {std::min(a.low, b.low), std::min(a.high, b.high)};
}

ValueInterval maximum(ValueInterval a, ValueInterval b) {
    return {std::max(a.low, b.low), std::max(a.high, b.high)};
}

ValueInterval hull(ValueInterval a, ValueInterval b) {
    return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

ValueInterval absolute(ValueInterval a) {
    if (a.low <= 0.0 && a.high >= 0.0) {
        return {0.0, std::max(-a.low, a.high)};
    }
    return a.low > 0.0 ? a : ValueInterval{-a.high, -a.low};
}

ValueInterval squareRoot(ValueInterval a) {
    return a.low < 0.0 ? kAnything : rising(a, [](double value) { return std::sqrt(value); });
}

ValueInterval logarithm(ValueInterval a) {
    return a.low < 0.0 ? kAnything : rising(a, [](double value) { return std::log(value); });
}

ValueInterval exponential(ValueInterval a) {
    return rising(a, [](double value) { return std::exp(value); });
}

ValueInterval sine(ValueInterval a) {
    return periodic(a, [](double value) { return std::sin(value); });
}

ValueInterval cosine(ValueInterval a) {
    return periodic(a, [](double value) { return std::cos(value); });
}

Certainty isEqual(ValueInterval a, ValueInterval b) {
    if (a.isExact() && a == b) {
        return Certainty::True;
    }
    return a.high < b.low || b.high < a.low ? Certainty::False : Certainty::Unknown;
}

Certainty isLess(ValueInterval a, ValueInterval b) {
    if (a.high < b.low) {
        return Certainty::True;
    }
    return a.low >= b.high ? Certainty::False : Certainty::Unknown;
}

Certainty isAtMost(ValueInterval a, ValueInterval b) {
    return !isLess(b, a);
}

}  // namespace glint::materials
