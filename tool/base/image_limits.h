// The largest size of a picture.
#pragma once

#include <cstdint>

namespace glint::base {

inline constexpr std::int64_t kMaxImageSize = 16384;  // pixels, each way
// This is 1 GiB as LinearImage, and limits the size that a small file can claim.
inline constexpr std::int64_t kMaxImagePixels = std::int64_t{1} << 26;

}  // namespace glint::base
