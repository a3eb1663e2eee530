// The largest size of a picture.
#pragma once

#include <glint/result.h>

#include <cstdint>
#include <string>

namespace glint::base {

inline constexpr std::int64_t kMaxImageSize = 16384;  // pixels, each way
// This is 1 GiB as LinearImage, and limits the size that a small file can claim.
inline constexpr std::int64_t kMaxImagePixels = std::int64_t{1} << 26;

// Returns the error "image-size" if a picture is empty or larger than this.
Status checkImageSize(std::int64_t width, std::int64_t height, const std::string& where);

}  // namespace glint::base
