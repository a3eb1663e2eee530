#include "sky/sky_counts.h"

#include "interop/lights.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>

namespace glint {
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

}  // namespace glint
