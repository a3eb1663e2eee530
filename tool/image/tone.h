// Converts linear radiance for a display: exposure, tone mapping, the sRGB transfer function.
#pragma once

#include <glint/image.h>

#include <array>
#include <cstdint>
#include <span>

namespace glint::image {

// A linear Rec. 709 colour.
using Rgb = std::array<float, 3>;

// Returns the relative luminance of a linear Rec. 709 colour (ITU-R BT.709).
double luminance(const Rgb& color);

// These are the sRGB transfer function (IEC 61966-2-1) and its inverse, from [0, 1] to [0, 1].
float linearToSrgb(float value);
float srgbToLinear(float value);

// Applies the Khronos PBR Neutral tone mapper (KhronosGroup/ToneMapping, PBR_Neutral, "PBR Neutral
// Specification"). It keeps base colours up to 0.8 and compresses highlights; the result is within [0, 1].
Rgb toneMapNeutral(const Rgb& color);

// The limit of an exposure in stops, either way.
inline constexpr double kMaxExposure = 32.0;

// Returns the exposure in stops that brings the log-average luminance of surfaces to a mid-grey of 0.18
// (Reinhard et al. 2002, "Photographic Tone Reproduction for Digital Images", equations 1 and 2), within
// kMaxExposure. `surfaces` has a byte for each pixel, which is not 0 if the pixel sees a surface. All pixels
// count if it is empty or has no such pixel, as in a picture of the sky alone. Pixels that are not finite or
// are black do not count; a pixel is black if it is below a millionth of the median of those above 0. Returns
// 0 stops if no pixel is left.
double automaticExposure(const LinearImage& image, std::span<const std::uint8_t> surfaces = {});

// Returns the colour that a display shows for a linear one, in linear light within [0, 1]: the colour times
// 2^exposure, tone mapped. NaN and infinity become magenta, so that they are visible.
Rgb displayed(const Rgb& color, double exposure);
// Applies displayed() to every pixel; alpha stays.
LinearImage displayedImage(const LinearImage& image, double exposure);

// Returns the 8-bit sRGB value of a linear colour: displayed(), encoded and rounded.
std::array<std::uint8_t, 3> toDisplay(const Rgb& color, double exposure);

}  // namespace glint::image
