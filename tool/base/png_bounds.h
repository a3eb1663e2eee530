// Compares the size that a PNG file claims with the size that it can hold, because decoders allocate by the
// claim.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace glint::base {

// Returns why the file can't hold as many pixels as it claims; `width` and `height` are those that a decoder
// read from the header. Returns an empty text if it can.
std::string findPngExcess(std::span<const std::uint8_t> bytes, std::int64_t width, std::int64_t height);

}  // namespace glint::base
