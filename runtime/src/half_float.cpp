#include "half_float.h"

#include <bit>
#include <cmath>

namespace glint {

std::uint16_t toHalf(float value) {
    constexpr float kSmallestNormal = 0x1p-14F;
    if (value < kSmallestNormal) {
        // Multiples of 2^-24; 1024 of them are the smallest normal number, as their bits say too.
        return static_cast<std::uint16_t>(std::nearbyint(value * 0x1p24F));
    }
    const auto bits = std::bit_cast<std::uint32_t>(value);
    const std::uint32_t odd = bits >> 13U & 1U;
    // A carry out of the mantissa goes into the exponent, as it should. The biases differ by 112.
    return static_cast<std::uint16_t>(((bits + 0xFFFU + odd) >> 13U) - (112U << 10U));
}

}  // namespace glint
