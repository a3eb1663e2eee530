// What a PNG file says of itself, against what it can hold: decoders allocate by the former.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace glint {

// Why the file can't be what it says, with its size in pixels as a decoder read it from the header; empty if
// it can.
std::string findPngExcess(std::span<const std::uint8_t> bytes, std::int64_t width, std::int64_t height);

}  // namespace glint
