#include "scene/emission_texels.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace glint {
namespace {

// A triangle's texels are looked up on a level where its box has no more than so many in each axis.
constexpr std::uint32_t kMostCells = 16;
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

EmissionTexels::EmissionTexels(const ImageView& image, bool isColor) {
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
    const std::size_t texels = std::size_t{image.width} * image.height;
    Level level{image.width, image.height, std::vector<float>(texels)};
    for (std::size_t i = 0; i < texels; ++i) {
        level.values[i] =
            0.2126F * channelAt(4 * i) + 0.7152F * channelAt(4 * i + 1) + 0.0722F * channelAt(4 * i + 2);
    }
    while (level.values.size() > 1) {
        Level half = halfOf(level);
        levels_.push_back(std::move(level));
        level = std::move(half);
    }
    levels_.push_back(std::move(level));
}

double EmissionTexels::mean(const TexelBox& box, std::uint32_t wrapU, std::uint32_t wrapV) const {
    const TexelRange u = rangeOf(box.lower[0], box.upper[0], levels_.front().width, wrapU);
    const TexelRange v = rangeOf(box.lower[1], box.upper[1], levels_.front().height, wrapV);
    std::uint32_t number = 0;
    while ((u.last >> number) - (u.first >> number) >= kMostCells ||
           (v.last >> number) - (v.first >> number) >= kMostCells) {
        ++number;
    }
    const Level& level = levels_[number];
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
