#include "lights/emission_texels.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace glint {
namespace {

// A triangle's texels are looked up on a level where its box has no more than so many in each axis.
constexpr std::uint32_t kMostCells = 16;
// Levels that are larger than this along an axis are not kept.
constexpr std::uint32_t kMostKept = 256;
// SamplerEntry::wrapU.
constexpr std::uint32_t kWrapRepeat = 0;
constexpr std::uint32_t kWrapClamp = 1;

// Returns the linear value of each number that a channel may have.
std::vector<float> channelValues(bool isWide, bool isColor) {
    const std::size_t count = isWide ? 65536 : 256;
    std::vector<float> values(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double value = static_cast<double>(i) / static_cast<double>(count - 1);
        const double linear = value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
        values[i] = static_cast<float>(isColor ? linear : value);
    }
    return values;
}

// Texels [first, last] of an axis.
struct TexelRange {
    std::uint32_t first = 0;
    std::uint32_t last = 0;
};

TexelRange rangeOf(double lower, double upper, std::uint32_t size, std::uint32_t wrap) {
    const TexelRange whole{0, size - 1};
    // A linear filter reaches half a texel further, and coordinates are rounded.
    double first = std::floor(lower * size - 1.0);
    double last = std::floor(upper * size + 1.0);
    if (!(last - first < size)) {
        return whole;
    }
    const double end = size - 1.0;
    if (wrap == kWrapClamp) {
        first = std::clamp(first, 0.0, end);
        last = std::clamp(last, 0.0, end);
    } else if (wrap == kWrapRepeat) {
        const double turns = std::floor(first / size) * size;
        first -= turns;
        last -= turns;
    }
    if (first < 0.0 || last > end) {
        return whole;
    }
    return {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(last)};
}

}  // namespace

EmissionTexels::Level EmissionTexels::halfOf(const Level& level) {
    Level half{(level.width + 1) / 2, (level.height + 1) / 2, {}};
    half.values.reserve(std::size_t{half.width} * half.height);
    for (std::uint32_t y = 0; y < half.height; ++y) {
        for (std::uint32_t x = 0; x < half.width; ++x) {
            double sum = 0.0;
            int count = 0;
            for (std::uint32_t row = 2 * y; row < std::min(2 * y + 2, level.height); ++row) {
                for (std::uint32_t column = 2 * x; column < std::min(2 * x + 2, level.width); ++column) {
                    sum += level.values[std::size_t{row} * level.width + column];
                    ++count;
                }
            }
            half.values.push_back(static_cast<float>(sum / count));
        }
    }
    return half;
}

EmissionTexels::EmissionTexels(const ImageView& image, bool isColor)
    : width_(image.width), height_(image.height) {
    const bool isWide = image.format == ImageView::Format::Rgba16;
    const std::span<const std::uint8_t> pixels = isBlockFormat(image.format) ? image.decoded : image.pixels;
    const std::vector<float> values = channelValues(isWide, isColor);
    const auto channelAt = [&](std::size_t index) {
        if (!isWide) {
            return values[pixels[index]];
        }
        std::uint16_t number = 0;
        std::memcpy(&number, &pixels[2 * index], sizeof number);
        return values[number];
    };
    while (((std::max(width_, height_) - 1) >> skipped_) >= kMostKept) {
        ++skipped_;
    }
    const std::uint32_t side = 1U << skipped_;
    Level level{((width_ - 1) >> skipped_) + 1, ((height_ - 1) >> skipped_) + 1, {}};
    level.values.reserve(std::size_t{level.width} * level.height);
    for (std::uint32_t top = 0; top < height_; top += side) {
        const std::uint32_t rows = std::min(side, height_ - top);
        std::vector<double> sums(level.width);
        for (std::uint32_t y = top; y < top + rows; ++y) {
            for (std::uint32_t x = 0; x < width_; ++x) {
                const std::size_t texel = 4 * (std::size_t{y} * width_ + x);
                sums[x >> skipped_] += 0.2126F * channelAt(texel) + 0.7152F * channelAt(texel + 1) +
                                       0.0722F * channelAt(texel + 2);
            }
        }
        for (std::uint32_t x = 0; x < level.width; ++x) {
            const std::uint32_t columns = std::min(side, width_ - (x << skipped_));
            level.values.push_back(static_cast<float>(sums[x] / (static_cast<double>(rows) * columns)));
        }
    }
    while (level.values.size() > 1) {
        Level half = halfOf(level);
        levels_.push_back(std::move(level));
        level = std::move(half);
    }
    levels_.push_back(std::move(level));
}

double EmissionTexels::mean(const TexelBox& box, std::uint32_t wrapU, std::uint32_t wrapV) const {
    const TexelRange u = rangeOf(box.lower[0], box.upper[0], width_, wrapU);
    const TexelRange v = rangeOf(box.lower[1], box.upper[1], height_, wrapV);
    std::uint32_t number = skipped_;
    while ((u.last >> number) - (u.first >> number) >= kMostCells ||
           (v.last >> number) - (v.first >> number) >= kMostCells) {
        ++number;
    }
    const Level& level = levels_[number - skipped_];
    double sum = 0.0;
    int count = 0;
    for (std::uint32_t y = v.first >> number; y <= v.last >> number; ++y) {
        for (std::uint32_t x = u.first >> number; x <= u.last >> number; ++x) {
            sum += level.values[std::size_t{y} * level.width + x];
            ++count;
        }
    }
    return sum / count;
}

}  // namespace glint
