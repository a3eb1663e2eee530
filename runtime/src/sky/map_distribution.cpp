#include "sky/map_distribution.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace glint {
namespace {

struct Cell {
    std::size_t index = 0;
    double fraction = 0.0;  // position in the cell, [0, 1)
};

// Returns the cell of running sums that `target` falls into. It never returns a cell without weight.
Cell findCell(std::span<const double> sums, double target) {
    const auto after = std::upper_bound(sums.begin(), sums.end(), target);
    std::size_t index = static_cast<std::size_t>(after - sums.begin());
    // Rounding may bring the target up to the last sum.
    index = std::clamp<std::size_t>(index, 1, sums.size() - 1);
    while (index > 1 && sums[index] == sums[index - 1]) {
        --index;
    }
    const double width = sums[index] - sums[index - 1];
    return {index - 1, std::clamp((target - sums[index - 1]) / width, 0.0, 1.0)};
}

}  // namespace

MapDistribution::MapDistribution(const RadianceMap& map) : width_(map.width), height_(map.height) {
    weights_.reserve(map.texels.size());
    for (const Radiance& radiance : map.texels) {
        weights_.push_back(luminance(radiance));
    }
    if (std::ranges::all_of(weights_, [](float weight) { return weight <= 0.0F; })) {
        std::ranges::fill(weights_, 1.0F);
    }
    rowSums_.assign(1, 0.0);
    columnSums_.reserve(std::size_t{width_ + 1} * height_);
    for (std::uint32_t row = 0; row < height_; ++row) {
        double sum = 0.0;
        columnSums_.push_back(sum);
        for (std::uint32_t column = 0; column < width_; ++column) {
            sum += weights_[std::size_t{row} * width_ + column];
            columnSums_.push_back(sum);
        }
        rowSums_.push_back(rowSums_.back() + sum * texelSolidAngle(row, width_, height_));
    }
    total_ = rowSums_.back();
}

MapSample MapDistribution::sample(double row, double column) const {
    const Cell inRows = findCell(rowSums_, row * total_);
    const std::span<const double> sums(&columnSums_[inRows.index * (width_ + 1)], width_ + 1);
    const Cell inColumns = findCell(sums, column * sums.back());
    const auto rowIndex = static_cast<std::uint32_t>(inRows.index);
    const double above = cosineAbove(rowIndex, height_);
    const double cosine = above + inRows.fraction * (cosineAbove(rowIndex + 1, height_) - above);
    const double sine = std::sqrt(std::max(1.0 - cosine * cosine, 0.0));
    const double u = (static_cast<double>(inColumns.index) + inColumns.fraction) / width_;
    const double azimuth = 2.0 * std::numbers::pi * (u - 0.5);
    const std::size_t texel = inRows.index * width_ + inColumns.index;
    return {{sine * std::cos(azimuth), cosine, sine * std::sin(azimuth)}, texel, pdf(texel)};
}

}  // namespace glint
