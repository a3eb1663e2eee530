// Maps that the tests of environments share.
#pragma once

#include "sky/map_filter.h"
#include "sky/radiance_map.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numbers>

namespace glint::test {

inline constexpr double kPi = std::numbers::pi;

inline Direction directionOf(double column, double row, const RadianceMap& map) {
    const double polar = kPi * row / map.height;
    const double azimuth = 2.0 * kPi * (column / map.width - 0.5);
    return {std::sin(polar) * std::cos(azimuth), std::cos(polar), std::sin(polar) * std::sin(azimuth)};
}

inline RadianceMap makeMap(std::uint32_t width, std::uint32_t height,
                           const std::function<Radiance(const Direction&)>& radiance) {
    RadianceMap map{width, height, {}};
    for (std::uint32_t row = 0; row < height; ++row) {
        for (std::uint32_t column = 0; column < width; ++column) {
            map.texels.push_back(radiance(directionOf(column + 0.5, row + 0.5, map)));
        }
    }
    return map;
}

inline RadianceMap grayMap(std::uint32_t width, std::uint32_t height,
                           const std::function<double(const Direction&)>& value) {
    return makeMap(width, height, [&](const Direction& d) {
        const auto v = static_cast<float>(value(d));
        return Radiance{v, v, v};
    });
}

// Returns a sky of 1, and a sun of 2 x 2 texels with 1e5.
inline RadianceMap sunMap(std::uint32_t width, std::uint32_t height) {
    RadianceMap map = grayMap(width, height, [](const Direction&) { return 1.0; });
    for (const std::uint32_t row : {height / 4, height / 4 + 1}) {
        for (const std::uint32_t column : {width / 3, width / 3 + 1}) {
            map.texels[std::size_t{row} * width + column] = {1e5F, 8e4F, 5e4F};
        }
    }
    return map;
}

inline std::array<double, 3> flux(const RadianceMap& map) {
    std::array<double, 3> sum{};
    for (std::size_t i = 0; i < map.texels.size(); ++i) {
        const double solidAngle =
            texelSolidAngle(static_cast<std::uint32_t>(i / map.width), map.width, map.height);
        for (std::size_t channel = 0; channel < 3; ++channel) {
            sum[channel] += solidAngle * map.texels[i][channel];
        }
    }
    return sum;
}

inline double dot(const Direction& a, const Direction& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

}  // namespace glint::test
