#include "image/palette.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace glint::image {

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
