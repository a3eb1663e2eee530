// Colours that people tell apart, colour-blind people included.
#pragma once

#include "image/text.h"

#include <cstdint>

namespace glint::image {

// Colours of categories: seven of those of Okabe and Ito, "Color Universal Design" (2008), then the same
// paler, then the same darker. Black is left to pixels without a category.
inline constexpr std::uint32_t kCategoryColors = 21;
// Returns the colour of a number; numbers that are equal modulo kCategoryColors share one.
Color8 categoryColor(std::uint32_t number);

// Returns the colour of a quantity from 0 to 1, clamped: "viridis" by Smith and van der Walt (2015), which
// matplotlib has in the public domain (CC0). Its lightness grows evenly. It is interpolated between nine of
// its colours.
Color8 quantityColor(double share);

}  // namespace glint::image
