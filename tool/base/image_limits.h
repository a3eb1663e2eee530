// How large a picture may be.
#pragma once

#include <cstdint>

namespace glint::base {

inline constexpr std::int64_t kMaxImageSize = 16384;  // pixels, each way
// This is 1 GiB as LinearImage, and limits what a small file can claim.
inline constexpr std::int64_t kMaxImagePixels = std::int64_t{1} << 26;

}  // namespace glint::base
