#include "scene/half_float.h"

#include <bit>
#include <cmath>

namespace glint {

std::uint16_t toHalf(float value) {
    constexpr float kSmallestNormal = 0x1p-14F;
    if (value < kSmallestNormal) {
        // The result counts multiples of 2^-24. The count 1024 is the smallest normal number, and its bits
        // are the same as those of the count.
        return static_cast<std::uint16_t>(std::nearbyint(value * 0x1p24F));
    }
    const auto bits = std::bit_cast<std::uint32_t>(value);
    const std::uint32_t odd = bits >> 13U & 1U;
    // A carry out of the mantissa correctly increments the exponent. The biases differ by 112.
    return static_cast<std::uint16_t>(((bits + 0xFFFU + odd) >> 13U) - (112U << 10U));
}

}  // namespace glint
