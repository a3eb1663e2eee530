// Host functions that convert 16-bit texels.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace glint {

// Converts RGBA in sRGB of 16 bits a channel, native byte order, to linear values of 16 bits, because Vulkan
// has no 16-bit sRGB format. A step of the result is 1.5e-5 and the darkest step of 8-bit sRGB is 3.0e-4, so
// no difference is visible. Alpha is linear already. Requires 8 bytes a texel.
std::vector<std::uint8_t> linearizeRgba16(std::span<const std::uint8_t> texels);

// Converts RGBA of 16 bits a channel to the nearest values of 8 bits, in the same transfer function.
std::vector<std::uint8_t> narrowRgba16(std::span<const std::uint8_t> texels);

}  // namespace glint
