// Conversion to 16-bit floats.
#pragma once

#include <cstdint>

namespace glint {

inline constexpr float kMaxHalf = 65504.0F;

// Converts to IEC 60559 binary16, rounded to the nearest, ties to even. Requires 0 <= value <= kMaxHalf.
std::uint16_t toHalf(float value);

}  // namespace glint
