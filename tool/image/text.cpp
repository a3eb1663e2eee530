#include "image/text.h"

#include <stb_easy_font.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
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

namespace {

constexpr Color8 kOkabeIto[] = {{230, 159, 0}, {86, 180, 233}, {0, 158, 115},  {240, 228, 66},
                                {0, 114, 178}, {213, 94, 0},   {204, 121, 167}};

constexpr Color8 kViridis[] = {{68, 1, 84},    {71, 44, 122}, {59, 81, 139},  {44, 113, 142}, {33, 144, 141},
                               {39, 173, 129}, {92, 200, 99}, {170, 220, 50}, {253, 231, 37}};

std::uint8_t between(double from, double to, double share) {
    return static_cast<std::uint8_t>(std::lround(from + (to - from) * share));
}

}  // namespace

Color8 categoryColor(std::uint32_t number) {
    constexpr double kMixed = 0.45;  // with white, or with black
    const Color8 own = kOkabeIto[number % std::size(kOkabeIto)];
    const std::uint32_t round = number % kCategoryColors / std::size(kOkabeIto);
    const double target = round == 1 ? 255.0 : 0.0;
    const double share = round == 0 ? 0.0 : kMixed;
    return {between(own[0], target, share), between(own[1], target, share), between(own[2], target, share)};
}

Color8 quantityColor(double share) {
    const double place = std::clamp(share, 0.0, 1.0) * (std::size(kViridis) - 1);
    const auto first = std::min(static_cast<std::size_t>(place), std::size(kViridis) - 2);
    const double rest = place - static_cast<double>(first);
    const Color8& from = kViridis[first];
    const Color8& to = kViridis[first + 1];
    return {between(from[0], to[0], rest), between(from[1], to[1], rest), between(from[2], to[2], rest)};
}

}  // namespace glint::image
