// Interval arithmetic that encloses the results of a shader: the exact result of each operation for all
// arguments in the given intervals, and its rounded value. Glint has a type of its own, because libraries of
// intervals enclose real numbers, and a proof about floats needs the rounding of each operation with the
// error bound of the function that computes it.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace glint::verify {

// The numbers that an operation can give.
enum class Format : std::uint8_t {
    Single,   // 32-bit float
    Half,     // 16-bit float
    Integer,  // 32-bit integers; also truth values, as 0 and 1
};

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kLargestSingle = std::numeric_limits<float>::max();
inline constexpr double kSmallestNormalSingle = std::numeric_limits<float>::min();
inline constexpr double kLargestHalf = 65504.0;
inline constexpr double kHalfDenormalStep = 0x1p-24;

inline double nextBelow(double x) {
    if (x == 0.0) {
        return -std::numeric_limits<double>::denorm_min();
    }
    if (x == -kInfinity || std::isnan(x)) {
        return x;
    }
    const auto bits = std::bit_cast<std::int64_t>(x);
    return std::bit_cast<double>(x > 0.0 ? bits - 1 : bits + 1);
}

inline double nextAbove(double x) {
    return -nextBelow(-x);
}

// A sum rounded down, or up; its rounding error is known exactly (Knuth 1969).
inline double addDown(double a, double b) {
    const double sum = a + b;
    if (!std::isfinite(sum)) {
        return sum;
    }
    const double part = sum - a;
    const double error = (a - (sum - part)) + (b - part);
    return error < 0.0 ? nextBelow(sum) : sum;
}

inline double addUp(double a, double b) {
    return -addDown(-a, -b);
}

inline float nextFloatBelow(float x) {
    if (x == 0.0F) {
        return -std::numeric_limits<float>::denorm_min();
    }
    if (x == -std::numeric_limits<float>::infinity() || std::isnan(x)) {
        return x;
    }
    const auto bits = std::bit_cast<std::int32_t>(x);
    return std::bit_cast<float>(x > 0.0F ? bits - 1 : bits + 1);
}

// Beyond the largest float the result is that float or an infinity, whichever is on the right side.
inline double singleBelow(double x) {
    // The conversion of a double that no float is near is undefined in C++.
    if (x > kLargestSingle) {
        return x == kInfinity ? x : kLargestSingle;
    }
    if (x < -kLargestSingle) {
        return -kInfinity;
    }
    const auto nearest = static_cast<float>(x);
    return static_cast<double>(nearest) > x ? nextFloatBelow(nearest) : nearest;
}

inline double halfBelow(double x) {
    if (x > kLargestHalf) {
        return x == kInfinity ? x : kLargestHalf;
    }
    if (x < -kLargestHalf) {
        return -kInfinity;
    }
    const int exponent = x == 0.0 ? -14 : std::max(std::ilogb(x), -14);
    const double step = std::ldexp(1.0, exponent - 10);
    return std::floor(x / step) * step;
}

inline double roundDown(double x, Format format) {
    switch (format) {
        case Format::Single:
            return singleBelow(x);
        case Format::Half:
            return halfBelow(x);
        case Format::Integer:
            break;
    }
    return std::ceil(x);
}

inline double roundUp(double x, Format format) {
    return format == Format::Integer ? std::floor(x) : -roundDown(-x, format);
}

inline double largestOf(Format format) {
    return format == Format::Half ? kLargestHalf : kLargestSingle;
}

// Half of the distance between numbers of the format near 1, and half of the distance near 0.
inline double unitRoundoff(Format format) {
    return format == Format::Half ? 0x1p-11 : 0x1p-24;
}
inline double halfDenormal(Format format) {
    return format == Format::Half ? 0x1p-25 : 0x1p-150;
}

// All numbers from low to high; an infinite end belongs to it. Ends are numbers of the format of the
// operation that made them.
struct Interval {
    double low = -kInfinity;
    double high = kInfinity;

    static constexpr Interval of(double value) {
        return {value, value};
    }
    static constexpr Interval nothing() {
        return {kInfinity, -kInfinity};
    }
    // Is also true for ends that are not numbers.
    bool isEmpty() const {
        return !(low <= high);
    }
    bool isPoint() const {
        return low == high;
    }
    bool isFinite() const {
        return low > -kInfinity && high < kInfinity;
    }
    bool contains(double value) const {
        return low <= value && value <= high;
    }
    bool isWithin(const Interval& other) const {
        return other.low <= low && high <= other.high;
    }
    double width() const {
        return high - low;
    }
    double magnitude() const {
        return std::max(std::abs(low), std::abs(high));
    }
    // Operations on truth values.
    bool isTrue() const {
        return low == 1.0 && high == 1.0;
    }
    bool isFalse() const {
        return low == 0.0 && high == 0.0;
    }
    bool operator==(const Interval&) const = default;
};

inline constexpr Interval kUndecided{0.0, 1.0};
inline constexpr Interval kTrue{1.0, 1.0};
inline constexpr Interval kFalse{0.0, 0.0};

inline Interval hull(const Interval& a, const Interval& b) {
    return a.isEmpty() ? b : b.isEmpty() ? a : Interval{std::min(a.low, b.low), std::max(a.high, b.high)};
}
inline Interval meet(const Interval& a, const Interval& b) {
    return {std::max(a.low, b.low), std::min(a.high, b.high)};
}

// The ways in which an operation can fail. Each is a bit.
enum class Hazard : std::uint16_t {
    None = 0,
    DivisionByZero = 1 << 0,
    RootOfNegative = 1 << 1,
    LogOfNonPositive = 1 << 2,
    ArcBeyondOne = 1 << 3,
    PowerOfNegative = 1 << 4,
    Overflow = 1 << 5,
    IndefiniteForm = 1 << 6,  // ∞ - ∞, 0 × ∞, ∞ / ∞
    Conversion = 1 << 7,      // to an integer that cannot hold it
    ArcOfOrigin = 1 << 8,     // atan(0, 0)
};
inline Hazard operator|(Hazard a, Hazard b) {
    return static_cast<Hazard>(static_cast<unsigned>(a) | static_cast<unsigned>(b));
}
inline Hazard& operator|=(Hazard& a, Hazard b) {
    return a = a | b;
}

// Functions of one argument.
enum class Function : std::uint8_t {
    Sqrt,
    InverseSqrt,
    Exp,
    Exp2,
    Log,
    Log2,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
};

// Operations of one precision. A result may lie anywhere between the numbers of the format around the exact
// one, so that it does not matter whether a product and a sum are fused. Functions of the C library get two
// units in the last place more than that: glibc's single-precision functions are within one ("Errors in Math
// Functions" in its manual).
//
// An operation that may fail for some arguments adds its hazard, and encloses the results for the others.
class Arithmetic {
public:
    explicit Arithmetic(Format format) : format_(format) {}

    Interval add(const Interval& a, const Interval& b, Hazard& hazard) const;
    Interval subtract(const Interval& a, const Interval& b, Hazard& hazard) const;
    Interval multiply(const Interval& a, const Interval& b, Hazard& hazard) const;
    Interval square(const Interval& a, Hazard& hazard) const;
    Interval divide(const Interval& a, const Interval& b, Hazard& hazard) const;
    Interval apply(Function function, const Interval& a, Hazard& hazard) const;
    // Requires a >= 0, as GLSL does; 0 needs b > 0.
    Interval power(const Interval& a, const Interval& b, Hazard& hazard) const;
    Interval arcTangent(const Interval& y, const Interval& x, Hazard& hazard) const;
    // x (1 - t) + y t, or x + t (y - x).
    Interval mix(const Interval& x, const Interval& y, const Interval& t, Hazard& hazard) const;
    // x / √(x² + rest), where rest >= 0 and x² + rest is a normal number.
    Interval normalized(const Interval& x, const Interval& rest) const;
    // Rounds to the format.
    Interval convert(const Interval& a, Hazard& hazard) const;

    Format format() const {
        return format_;
    }

private:
    Interval root(Function function, Interval a, Hazard& hazard) const;
    Interval rounded(double low, double high, Hazard& hazard) const;
    Interval widened(double low, double high, Hazard& hazard) const;

    Format format_;
};

}  // namespace glint::verify
