#include "image/text.h"

#include <stb_easy_font.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

namespace glint::image {

namespace {

// The library takes text that it may write to, and knows ASCII alone.
std::string drawable(std::string_view text) {
    std::string ascii;
    for (const char character : text) {
        const auto byte = static_cast<unsigned char>(character);
        const bool continues = (byte & 0xC0U) == 0x80U;  // of a character of several bytes
        if (!continues) {
            ascii += byte >= ' ' && byte < 0x7F ? character : '?';
        }
    }
    return ascii;
}

// A corner of the quads that the library makes.
struct QuadCorner {
    float x, y, z;
    std::uint8_t color[4];
};

}  // namespace

std::uint32_t textWidth(std::string_view text) {
    std::string ascii = drawable(text);
    return static_cast<std::uint32_t>(stb_easy_font_width(ascii.data()));
}

std::string fittedText(std::string_view text, std::uint32_t width) {
    std::string fitted(text);
    if (textWidth(fitted) <= width) {
        return fitted;
    }
    while (!fitted.empty() && textWidth(fitted + "..") > width) {
        fitted.pop_back();
    }
    return fitted + "..";
}

void drawText(DisplayImage& image, std::uint32_t x, std::uint32_t y, std::string_view text, Color8 color,
              std::uint32_t scale) {
    std::string ascii = drawable(text);
    // A character has no more than some twenty quads.
    std::vector<QuadCorner> corners(ascii.size() * 32 * 4 + 4);
    const int quads = stb_easy_font_print(0.0F, 0.0F, ascii.data(), nullptr, corners.data(),
                                          static_cast<int>(corners.size() * sizeof(QuadCorner)));
    for (int i = 0; i < quads; ++i) {
        const QuadCorner& first = corners[static_cast<std::size_t>(i) * 4];
        const QuadCorner& opposite = corners[static_cast<std::size_t>(i) * 4 + 2];
        const auto at = [scale](float value) {
            return static_cast<std::uint32_t>(std::lround(value)) * scale;
        };
        fillArea(image, x + at(first.x), y + at(first.y), at(opposite.x) - at(first.x),
                 at(opposite.y) - at(first.y), color);
    }
}

void fillArea(DisplayImage& image, std::uint32_t x, std::uint32_t y, std::uint32_t width,
              std::uint32_t height, Color8 color) {
    for (std::uint32_t row = y; row < std::min(y + height, image.height); ++row) {
        for (std::uint32_t column = x; column < std::min(x + width, image.width); ++column) {
            image.pixels[std::size_t{row} * image.width + column] = color;
        }
    }
}

}  // namespace glint::image
