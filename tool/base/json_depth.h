// How deeply JSON nests: libraries copy, write and walk it by recursion, and a stack is small.
#pragma once

#include <cstdint>
#include <span>

namespace glint {

// What Glint reads and writes itself needs less than a dozen levels, `extras` of glTF seldom more.
inline constexpr int kMaxJsonDepth = 128;

// Whether arrays and objects are nested more than kMaxJsonDepth levels deep. The text need not be JSON.
bool nestsTooDeep(std::span<const std::uint8_t> json);

}  // namespace glint
