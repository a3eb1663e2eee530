// Directed rounding of doubles to the numbers of a shader: the greatest float (or 16-bit float) that is no
// greater than a value, and the least that is no less.
#pragma once

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

}  // namespace glint::verify
