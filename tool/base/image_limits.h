// The largest size of a picture, and the size that a PNG file can hold.
#pragma once

#include <glint/result.h>

#include <cstdint>
#include <span>
#include <string>

namespace glint::base {

inline constexpr std::int64_t kMaxImageSize = 16384;  // pixels, each way
// This is 1 GiB as LinearImage, and limits the size that a small file can claim.
inline constexpr std::int64_t kMaxImagePixels = std::int64_t{1} << 26;

// Returns the error "image-size" if a picture is empty or larger than this.
Status checkImageSize(std::int64_t width, std::int64_t height, const std::string& where);

// Compares the size that a PNG file claims with the size that it can hold, because decoders allocate by the
// claim.

// Returns why the file can't hold as many pixels as it claims; `width` and `height` are those that a decoder
// read from the header. Returns an empty text if it can.
std::string findPngExcess(std::span<const std::uint8_t> bytes, std::int64_t width, std::int64_t height);

}  // namespace glint::base
