// Conversions of 16-bit texels on the host.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace glint {

// RGBA of 16 bits a channel in sRGB, native byte order, as 16-bit linear: Vulkan has no 16-bit sRGB format. A
// step of the result is 1.5e-5, the darkest step of 8-bit sRGB is 3.0e-4, so that nothing shows. Alpha is
// linear already. Requires 8 bytes a texel.
std::vector<std::uint8_t> linearizeRgba16(std::span<const std::uint8_t> texels);

// RGBA of 16 bits a channel as the nearest of 8 bits, in the same transfer function.
std::vector<std::uint8_t> narrowRgba16(std::span<const std::uint8_t> texels);

}  // namespace glint
