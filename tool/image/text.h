// Draws text and areas into pictures for legends, in colours that people tell apart.
#pragma once

#include "image/png.h"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace glint::image {

using Color8 = std::array<std::uint8_t, 3>;  // sRGB

// The height of a line of text of scale 1, pixels.
inline constexpr std::uint32_t kLineHeight = 12;

// Returns the width of a line of scale 1, pixels. Characters outside of ASCII are drawn as '?'.
std::uint32_t textWidth(std::string_view text);

// Returns the text, or as much of its beginning as fits into `width` pixels at scale 1 with ".." behind it.
std::string fittedText(std::string_view text, std::uint32_t width);

// Draws a line with its upper left corner at (x, y), each point of the font `scale` pixels wide. Parts
// outside of the picture are left out. The font is that of stb_easy_font.h.
void drawText(DisplayImage& image, std::uint32_t x, std::uint32_t y, std::string_view text, Color8 color,
              std::uint32_t scale);

// Fills a rectangle, as far as it is in the picture.
void fillArea(DisplayImage& image, std::uint32_t x, std::uint32_t y, std::uint32_t width,
              std::uint32_t height, Color8 color);

// --- Colours that people tell apart, colour-blind people included ---

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
