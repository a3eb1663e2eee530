#include "sky/radiance_map.h"

#include "context/context.h"
#include "interop/lights.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <string>
#include <vector>

namespace glint {
namespace {

// The source cells [first, first + weights.size()) that a target cell covers, and the share that each has of
// it.
struct Coverage {
    std::uint32_t first = 0;
    std::vector<double> weights;  // their sum is 1
};

// Cells divide [0, 1] evenly. `measure` is monotonic and maps [0, 1] to the measure by which shares are
// weighted.
template <typename Measure>
std::vector<Coverage> coverages(std::uint32_t sources, std::uint32_t targets, const Measure& measure) {
    std::vector<Coverage> result(targets);
    for (std::uint64_t target = 0; target < targets; ++target) {
        const double begin = measure(static_cast<double>(target) / targets);
        const double end = measure(static_cast<double>(target + 1) / targets);
        const std::uint64_t first = target * sources / targets;
        const std::uint64_t last = ((target + 1) * sources + targets - 1) / targets;
        Coverage& coverage = result[target];
        coverage.first = static_cast<std::uint32_t>(first);
        for (std::uint64_t source = first; source < last; ++source) {
            const double from = std::clamp(measure(static_cast<double>(source) / sources),
                                           std::min(begin, end), std::max(begin, end));
            const double to = std::clamp(measure(static_cast<double>(source + 1) / sources),
                                         std::min(begin, end), std::max(begin, end));
            coverage.weights.push_back((to - from) / (end - begin));
        }
    }
    return result;
}

Diagnostic radianceError(const std::string& what, std::size_t pixel, std::uint32_t width) {
    return makeError(
        "environment-radiance", "",
        phrase("the pixel at column ", pixel % width, ", row ", pixel / width, " from the top left ", what),
        "correct the image: radiance is 0 to 1e18");
}

}  // namespace

Result<CheckedMap> checkMap(const LinearImage& image) {
    const std::size_t count = std::size_t{image.width} * image.height;
    if (count == 0 || image.pixels.size() != count) {
        return makeError("environment-size", "",
                         phrase("the environment's image is ", image.width, " x ", image.height, " with ",
                                image.pixels.size(), " pixels"),
                         "give an image with all its pixels");
    }
    CheckedMap checked;
    checked.map = {image.width, image.height, {}};
    checked.map.texels.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        bool negative = false;
        for (std::size_t channel = 0; channel < 3; ++channel) {
            const float value = image.pixels[i][channel];
            if (!(std::abs(value) <= kMaxRadiance)) {
                return radianceError(std::isnan(value)   ? "is NaN"
                                     : std::isinf(value) ? "is infinite"
                                                         : "is brighter than 1e18",
                                     i, image.width);
            }
            negative = negative || value < 0.0F;
            checked.map.texels[i][channel] = std::max(value, 0.0F);
        }
        checked.negativePixels += negative ? 1 : 0;
    }
    return checked;
}

double cosineAbove(std::uint32_t row, std::uint32_t height) {
    return std::cos(std::numbers::pi * row / height);
}

double texelSolidAngle(std::uint32_t row, std::uint32_t width, std::uint32_t height) {
    return 2.0 * std::numbers::pi / width * (cosineAbove(row, height) - cosineAbove(row + 1, height));
}

RadianceMap resample(const RadianceMap& map, std::uint32_t width, std::uint32_t height) {
    const std::vector<Coverage> columns = coverages(map.width, width, [](double u) { return u; });
    const std::vector<Coverage> rows =
        coverages(map.height, height, [](double v) { return std::cos(std::numbers::pi * v); });
    RadianceMap result{width, height, {}};
    result.texels.reserve(std::size_t{width} * height);
    std::vector<std::array<double, 3>> row(map.width);
    for (const Coverage& covered : rows) {
        row.assign(map.width, {});
        for (std::size_t i = 0; i < covered.weights.size(); ++i) {
            const Radiance* source = &map.texels[(covered.first + i) * map.width];
            for (std::uint32_t x = 0; x < map.width; ++x) {
                for (std::size_t channel = 0; channel < 3; ++channel) {
                    row[x][channel] += covered.weights[i] * source[x][channel];
                }
            }
        }
        for (const Coverage& column : columns) {
            std::array<double, 3> sum{};
            for (std::size_t i = 0; i < column.weights.size(); ++i) {
                for (std::size_t channel = 0; channel < 3; ++channel) {
                    sum[channel] += column.weights[i] * row[column.first + i][channel];
                }
            }
            result.texels.push_back(
                {static_cast<float>(sum[0]), static_cast<float>(sum[1]), static_cast<float>(sum[2])});
        }
    }
    return result;
}

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

namespace {

// The share of the mean weight that every direction has at least.
constexpr double kDefensiveShare = 0.01;

// Returns the mean luminance of bilinear lookups within each texel. A tent over two texels has 1/8, 3/4 and
// 1/8 of its area in a texel and its neighbours. Columns wrap around, and rows end at the poles.
RadianceMap interpolatedLuminance(const RadianceMap& map) {
    const auto at = [](std::uint32_t last, std::uint32_t here, std::uint32_t next, const auto& value) {
        return 0.125 * value(last) + 0.75 * value(here) + 0.125 * value(next);
    };
    std::vector<double> across(map.texels.size());
    RadianceMap result{map.width, map.height, {}};
    result.texels.reserve(map.texels.size());
    for (std::uint32_t row = 0; row < map.height; ++row) {
        const std::size_t first = std::size_t{row} * map.width;
        for (std::uint32_t column = 0; column < map.width; ++column) {
            across[first + column] =
                at((column + map.width - 1) % map.width, column, (column + 1) % map.width,
                   [&](std::uint32_t c) { return double{luminance(map.texels[first + c])}; });
        }
    }
    for (std::uint32_t row = 0; row < map.height; ++row) {
        for (std::uint32_t column = 0; column < map.width; ++column) {
            const auto value = static_cast<float>(
                at(row == 0 ? 0 : row - 1, row, std::min(row + 1, map.height - 1),
                   [&](std::uint32_t r) { return across[std::size_t{r} * map.width + column]; }));
            result.texels.push_back({value, value, value});
        }
    }
    return result;
}

// Appends running sums of integers of at least 1 that add up to kSkyCounts, in proportion to the weights. The
// weights must not all be 0.
void appendCounts(std::span<const double> weights, std::vector<std::uint32_t>& counts) {
    const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
    const double shared = static_cast<double>(gpu::kSkyCounts) - static_cast<double>(weights.size());
    double sum = 0.0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        sum += weights[i];
        const double share = i + 1 == weights.size() ? 1.0 : std::min(sum / total, 1.0);
        counts.push_back(static_cast<std::uint32_t>(i + 1) +
                         static_cast<std::uint32_t>(std::floor(share * shared)));
    }
}

}  // namespace

SkyCounts skyCounts(const RadianceMap& map) {
    SkyCounts result;
    result.columns = std::min(map.width, kMostSkyColumns);
    result.rows = std::min(map.height, kMostSkyRows);
    const RadianceMap cells = resample(interpolatedLuminance(map), result.columns, result.rows);
    // The mean over the sphere, of the cells' means by solid angle.
    double mean = 0.0;
    for (std::size_t i = 0; i < cells.texels.size(); ++i) {
        const auto row = static_cast<std::uint32_t>(i / result.columns);
        mean +=
            cells.texels[i][0] * texelSolidAngle(row, result.columns, result.rows) / (4.0 * std::numbers::pi);
    }
    const double least = mean > 0.0 ? kDefensiveShare * mean : 1.0;
    std::vector<double> weights;
    weights.reserve(cells.texels.size());
    for (const Radiance& cell : cells.texels) {
        weights.push_back(cell[0] + least);
    }
    std::vector<double> ofRows;
    for (std::uint32_t row = 0; row < result.rows; ++row) {
        const std::span<const double> inRow(&weights[std::size_t{row} * result.columns], result.columns);
        ofRows.push_back(std::accumulate(inRow.begin(), inRow.end(), 0.0) *
                         texelSolidAngle(row, result.columns, result.rows));
    }
    result.counts.reserve(std::size_t{result.rows} * (1 + result.columns));
    appendCounts(ofRows, result.counts);
    for (std::uint32_t row = 0; row < result.rows; ++row) {
        appendCounts({&weights[std::size_t{row} * result.columns], result.columns}, result.counts);
    }
    return result;
}

std::uint16_t toHalf(float value) {
    constexpr float kSmallestNormal = 0x1p-14F;
    if (value < kSmallestNormal) {
        // The result counts multiples of 2^-24. The count 1024 is the smallest normal number, and its bits
        // are the same as those of the count.
        return static_cast<std::uint16_t>(std::nearbyint(value * 0x1p24F));
    }
    const auto bits = std::bit_cast<std::uint32_t>(value);
    const std::uint32_t odd = bits >> 13U & 1U;
    // A carry out of the mantissa correctly increments the exponent. The biases differ by 112.
    return static_cast<std::uint16_t>(((bits + 0xFFFU + odd) >> 13U) - (112U << 10U));
}

}  // namespace glint
