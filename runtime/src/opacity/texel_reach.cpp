#include "opacity/texel_reach.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace glint::opacity {
namespace {

// Beyond this distance 32 bits no longer distinguish texels, and the whole image counts as reached.
constexpr double kFarthest = 0x1p22;
// An image that is repeated more often counts as reached whole.
constexpr double kMostRepeats = 4.0;

std::int64_t floorDivided(std::int64_t value, std::int64_t by) {
    return value / by - (value % by < 0 ? 1 : 0);
}

void extendRun(const std::uint8_t* texels, std::int64_t first, std::int64_t last, TexelRange& range) {
    std::uint8_t least = 255;
    std::uint8_t most = 0;
    for (std::int64_t i = first; i <= last; ++i) {
        least = std::min(least, texels[i]);
        most = std::max(most, texels[i]);
    }
    range.least = std::min<std::uint32_t>(range.least, least);
    range.most = std::max<std::uint32_t>(range.most, most);
}

struct Ends {
    double least = std::numeric_limits<double>::infinity();
    double most = -std::numeric_limits<double>::infinity();

    void extend(double value) {
        least = std::min(least, value);
        most = std::max(most, value);
    }
};

// The ends in x of the part of a triangle between two heights. Intersections are rounded in double, which the
// margins of the lookup cover many times.
Ends endsBetween(const TexelTriangle& triangle, double lower, double upper) {
    Ends ends;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        const double fromY = triangle.y[i];
        const double toY = triangle.y[j];
        if (fromY >= lower && fromY <= upper) {
            ends.extend(triangle.x[i]);
        }
        for (const double height : {lower, upper}) {
            if ((fromY < height) != (toY < height)) {
                const double at = std::clamp((height - fromY) / (toY - fromY), 0.0, 1.0);
                ends.extend(triangle.x[i] + at * (triangle.x[j] - triangle.x[i]));
            }
        }
    }
    return ends;
}

}  // namespace

std::uint32_t wrapped(std::int64_t texel, std::uint32_t size, Wrap wrap) {
    const auto count = static_cast<std::int64_t>(size);
    if (wrap == Wrap::Clamp) {
        return static_cast<std::uint32_t>(std::clamp<std::int64_t>(texel, 0, count - 1));
    }
    const std::int64_t period = floorDivided(texel, count);
    const std::int64_t within = texel - period * count;
    const bool flipped = wrap == Wrap::Mirror && period % 2 != 0;
    return static_cast<std::uint32_t>(flipped ? count - 1 - within : within);
}

TexelWalk::TexelWalk(const AlphaLookup& lookup, const TexelTriangle& triangle)
    : lookup_(lookup),
      triangle_(triangle),
      // A linear filter at x reads the texels whose centres are within one texel of x.
      below_(lookup.linear ? 1.5 : 1.0),
      above_(lookup.linear ? 0.5 : 0.0) {
    const auto [lowX, highX] = std::ranges::minmax(triangle.x);
    const auto [lowY, highY] = std::ranges::minmax(triangle.y);
    const double far = std::max({-lowX, highX, -lowY, highY}) + triangle.marginX + triangle.marginY;
    whole_ = !(far < kFarthest) || highY - lowY > kMostRepeats * lookup.texels->height + 16.0;
    if (!whole_) {
        row_ = static_cast<std::int64_t>(std::ceil(lowY - below_ - triangle.marginY));
        lastRow_ = static_cast<std::int64_t>(std::floor(highY + above_ + triangle.marginY));
    }
}

bool TexelWalk::next(TexelRange& range) {
    if (whole_) {
        whole_ = false;
        extendAll(range);
        return true;
    }
    if (row_ > lastRow_) {
        return false;
    }
    const auto row = static_cast<double>(row_);
    const Ends ends =
        endsBetween(triangle_, row - above_ - triangle_.marginY, row + below_ + triangle_.marginY);
    if (ends.least <= ends.most) {
        extendRow(row_, static_cast<std::int64_t>(std::ceil(ends.least - below_ - triangle_.marginX)),
                  static_cast<std::int64_t>(std::floor(ends.most + above_ + triangle_.marginX)), range);
    }
    ++row_;
    return true;
}

void TexelWalk::extendAll(TexelRange& range) const {
    const AlphaTexels& texels = *lookup_.texels;
    extendRun(texels.alpha.data(), 0, std::int64_t{texels.width} * texels.height - 1, range);
}

void TexelWalk::extendRow(std::int64_t row, std::int64_t first, std::int64_t last, TexelRange& range) const {
    const AlphaTexels& texels = *lookup_.texels;
    const auto width = static_cast<std::int64_t>(texels.width);
    const std::uint8_t* const line =
        texels.alpha.data() + std::size_t{wrapped(row, texels.height, lookup_.wrapV)} * texels.width;
    if (lookup_.wrapU == Wrap::Clamp) {
        extendRun(line, wrapped(first, texels.width, Wrap::Clamp), wrapped(last, texels.width, Wrap::Clamp),
                  range);
        return;
    }
    if (last - first + 1 >= width) {
        extendRun(line, 0, width - 1, range);
        return;
    }
    // At most two repetitions of the image are touched.
    while (first <= last) {
        const std::int64_t end = std::min(last, (floorDivided(first, width) + 1) * width - 1);
        const std::int64_t a = wrapped(first, texels.width, lookup_.wrapU);
        const std::int64_t b = wrapped(end, texels.width, lookup_.wrapU);
        extendRun(line, std::min(a, b), std::max(a, b), range);
        first = end + 1;
    }
}

}  // namespace glint::opacity
