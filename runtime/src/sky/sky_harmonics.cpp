#include "sky/sky_harmonics.h"

#include <cmath>
#include <numbers>
#include <vector>

namespace glint {
namespace {

// Integrals over the azimuth φ of one column.
struct ColumnIntegrals {
    double cos1 = 0.0;  // integral of cos φ
    double sin1 = 0.0;
    double cos2 = 0.0;  // integral of cos 2φ
    double sin2 = 0.0;
};

std::vector<ColumnIntegrals> columnIntegrals(std::uint32_t width) {
    std::vector<ColumnIntegrals> columns(width);
    for (std::uint32_t i = 0; i < width; ++i) {
        const double from = 2.0 * std::numbers::pi * (static_cast<double>(i) / width - 0.5);
        const double to = 2.0 * std::numbers::pi * (static_cast<double>(i + 1) / width - 0.5);
        columns[i] = {std::sin(to) - std::sin(from), std::cos(from) - std::cos(to),
                      (std::sin(2.0 * to) - std::sin(2.0 * from)) / 2.0,
                      (std::cos(2.0 * from) - std::cos(2.0 * to)) / 2.0};
    }
    return columns;
}

// Integrals over y from -1, with s = √(1 - y²). They are the antiderivatives of 1, y, s, ys, s², 3y² - 1.
struct RowIntegrals {
    explicit RowIntegrals(double y)
        : one(y),
          y1(y * y / 2.0),
          s1((y * std::sqrt(1.0 - y * y) + std::asin(y)) / 2.0),
          ys(-std::pow(1.0 - y * y, 1.5) / 3.0),
          s2(y - y * y * y / 3.0),
          p2(y * y * y - y) {}
    double one, y1, s1, ys, s2, p2;
};

// Sums over a row, for each channel.
struct RowSums {
    double one = 0.0;
    double cos1 = 0.0;
    double sin1 = 0.0;
    double cos2 = 0.0;
    double sin2 = 0.0;
};

void addRow(const RowIntegrals& above, const RowIntegrals& below, const RowSums& sums, std::size_t channel,
            SkyHarmonics& h) {
    const double s1 = above.s1 - below.s1;
    const double ys = above.ys - below.ys;
    const double s2 = above.s2 - below.s2;
    h[0][channel] += (above.one - below.one) * sums.one;
    h[1][channel] += s1 * sums.cos1;
    h[2][channel] += (above.y1 - below.y1) * sums.one;
    h[3][channel] += s1 * sums.sin1;
    h[4][channel] += (above.p2 - below.p2) * sums.one;
    h[5][channel] += ys * sums.cos1;
    h[6][channel] += ys * sums.sin1;
    h[7][channel] += s2 * sums.sin2 / 2.0;
    h[8][channel] += s2 * sums.cos2;
}

}  // namespace

SkyHarmonics skyHarmonics(const RadianceMap& map) {
    const std::vector<ColumnIntegrals> columns = columnIntegrals(map.width);
    const double columnAngle = 2.0 * std::numbers::pi / map.width;
    SkyHarmonics h{};
    for (std::uint32_t row = 0; row < map.height; ++row) {
        std::array<RowSums, 3> sums{};
        for (std::uint32_t x = 0; x < map.width; ++x) {
            const Radiance& radiance = map.texels[std::size_t{row} * map.width + x];
            for (std::size_t channel = 0; channel < 3; ++channel) {
                const double value = radiance[channel];
                sums[channel].one += value * columnAngle;
                sums[channel].cos1 += value * columns[x].cos1;
                sums[channel].sin1 += value * columns[x].sin1;
                sums[channel].cos2 += value * columns[x].cos2;
                sums[channel].sin2 += value * columns[x].sin2;
            }
        }
        const RowIntegrals above(cosineAbove(row, map.height));
        const RowIntegrals below(cosineAbove(row + 1, map.height));
        for (std::size_t channel = 0; channel < 3; ++channel) {
            addRow(above, below, sums[channel], channel, h);
        }
    }
    // Each factor is the square of the basis function's constant, times the cosine lobe's coefficient over π:
    // 1, 2/3, 1/4.
    constexpr double kPi = std::numbers::pi;
    constexpr double kFactors[9] = {1.0 / (4.0 * kPi),   1.0 / (2.0 * kPi),   1.0 / (2.0 * kPi),
                                    1.0 / (2.0 * kPi),   5.0 / (64.0 * kPi),  15.0 / (16.0 * kPi),
                                    15.0 / (16.0 * kPi), 15.0 / (16.0 * kPi), 15.0 / (64.0 * kPi)};
    for (std::size_t i = 0; i < h.size(); ++i) {
        for (double& channel : h[i]) {
            channel *= kFactors[i];
        }
    }
    return h;
}

SkyHarmonics turned(const SkyHarmonics& harmonics, double angle) {
    SkyHarmonics result = harmonics;
    const double c1 = std::cos(angle);
    const double s1 = std::sin(angle);
    const double c2 = std::cos(2.0 * angle);
    const double s2 = std::sin(2.0 * angle);
    for (std::size_t channel = 0; channel < 3; ++channel) {
        // These coefficients belong to cos φ and sin φ, to which x and z are proportional.
        for (const auto& [x, z] : {std::pair{1, 3}, std::pair{5, 6}}) {
            const double a = harmonics[x][channel];
            const double b = harmonics[z][channel];
            result[x][channel] = a * c1 + b * s1;
            result[z][channel] = b * c1 - a * s1;
        }
        // These coefficients belong to cos 2φ and sin 2φ. xz is half of sin 2φ, up to a common factor.
        const double a = harmonics[8][channel];
        const double b = harmonics[7][channel] / 2.0;
        result[8][channel] = a * c2 + b * s2;
        result[7][channel] = 2.0 * (b * c2 - a * s2);
    }
    return result;
}

}  // namespace glint
