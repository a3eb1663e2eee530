// Limits how deeply JSON nests, because libraries copy, write and walk it by recursion, and a stack is small.
#pragma once

#include <cstdint>
#include <span>

namespace glint::base {

// The files that Glint reads and writes need fewer than a dozen levels, and `extras` of glTF seldom need
// more.
inline constexpr int kMaxJsonDepth = 128;

// Returns whether arrays and objects are nested more than kMaxJsonDepth levels deep. The text need not be
// JSON.
bool nestsTooDeep(std::span<const std::uint8_t> json);

}  // namespace glint::base
