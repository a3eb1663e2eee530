// Intervals of numbers, and conditions on them. Bounds are computed in double precision from the ends, so an
// exact value stays exact.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <limits>

namespace glint::materials {

inline constexpr double kUnlimited = std::numeric_limits<double>::infinity();

// All values that a number can take, both ends included. The ends are ordered, and never NaN.
struct ValueInterval {
    double low = 0.0;
    double high = 0.0;

    bool isExact() const {
        return low == high;
    }
    // The compiler generates a comparison with 0 here. NOLINTNEXTLINE(modernize-use-nullptr)
    auto operator<=>(const ValueInterval&) const = default;
};

inline constexpr ValueInterval kAnything{-kUnlimited, kUnlimited};
inline constexpr ValueInterval kUnitInterval{0.0, 1.0};

// The certainty of a condition: it holds for all values, for none, or for some.
enum class Certainty : std::uint8_t { False, True, Unknown };

Certainty operator!(Certainty certainty);
Certainty operator&&(Certainty a, Certainty b);
Certainty operator||(Certainty a, Certainty b);

constexpr Certainty certain(bool holds) {
    return holds ? Certainty::True : Certainty::False;
}

// A number of one to four channels.
struct Channels {
    std::array<ValueInterval, 4> of{};
    int count = 1;
};

constexpr Channels exactly(double value) {
    return {{ValueInterval{value, value}}, 1};
}

// Operations whose result depends on a division by zero, or on a value outside of a function's domain, give
// kAnything.
ValueInterval add(ValueInterval a, ValueInterval b);
ValueInterval subtract(ValueInterval a, ValueInterval b);
ValueInterval multiply(ValueInterval a, ValueInterval b);
ValueInterval divide(ValueInterval a, ValueInterval b);
ValueInterval minimum(ValueInterval a, ValueInterval b);
ValueInterval maximum(ValueInterval a, ValueInterval b);
ValueInterval hull(ValueInterval a, ValueInterval b);
ValueInterval absolute(ValueInterval a);
ValueInterval squareRoot(ValueInterval a);
ValueInterval logarithm(ValueInterval a);
ValueInterval exponential(ValueInterval a);
ValueInterval sine(ValueInterval a);
ValueInterval cosine(ValueInterval a);

Certainty isEqual(ValueInterval a, ValueInterval b);
Certainty isLess(ValueInterval a, ValueInterval b);
Certainty isAtMost(ValueInterval a, ValueInterval b);

}  // namespace glint::materials
