#include "gltf/image_content.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace glint::gltf {

namespace {

using materials::ValueInterval;

// The least and greatest code of each channel.
template <typename Code>
struct Codes {
    std::array<Code, 4> least{};
    std::array<Code, 4> greatest{};
};

template <typename Code>
Codes<Code> codesOf(const std::vector<std::uint8_t>& pixels) {
    Codes<Code> codes;
    codes.least.fill(std::numeric_limits<Code>::max());
    const std::size_t texels = pixels.size() / sizeof(std::array<Code, 4>);
    for (std::size_t i = 0; i < texels; ++i) {
        std::array<Code, 4> texel{};
        std::memcpy(texel.data(), &pixels[i * sizeof texel], sizeof texel);
        for (std::size_t channel = 0; channel < 4; ++channel) {
            codes.least[channel] = std::min(codes.least[channel], texel[channel]);
            codes.greatest[channel] = std::max(codes.greatest[channel], texel[channel]);
        }
    }
    return codes;
}

template <typename Code>
std::array<ValueInterval, 4> intervalsOf(const Codes<Code>& codes) {
    constexpr double kLargest = std::numeric_limits<Code>::max();
    std::array<ValueInterval, 4> intervals{};
    for (std::size_t channel = 0; channel < 4; ++channel) {
        intervals[channel] = {codes.least[channel] / kLargest, codes.greatest[channel] / kLargest};
    }
    return intervals;
}

// Where a device can't filter 16 bits, the runtime stores 8.
ValueInterval withNarrowed(ValueInterval value) {
    const auto narrowed = [](double number) { return std::round(number * 255.0) / 255.0; };
    return {std::min(value.low, narrowed(value.low)), std::max(value.high, narrowed(value.high))};
}

// IEC 61966-2-1.
double linearOf(double value) {
    return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

ValueInterval widened(ValueInterval value, double share) {
    const bool isWhite = value.low == 1.0;
    const bool isBlack = value.high == 0.0;
    return {isWhite ? 1.0 : value.low * (1.0 - share),
            isBlack ? 0.0 : std::min(value.high * (1.0 + share), 1.0)};
}

}  // namespace

std::array<ValueInterval, 4> storedContent(const Image& image) {
    if (image.format == PixelFormat::Rgba8) {
        return intervalsOf(codesOf<std::uint8_t>(image.pixels));
    }
    std::array<ValueInterval, 4> intervals = intervalsOf(codesOf<std::uint16_t>(image.pixels));
    std::ranges::transform(intervals, intervals.begin(), withNarrowed);
    return intervals;
}

std::array<ValueInterval, 4> contentAsRead(const std::array<ValueInterval, 4>& stored, bool isColor) {
    // Filters in single precision, and llvmpipe's sRGB, which is off by up to 0.7 %.
    constexpr double kFilter = 1e-5;
    constexpr double kSrgb = 0.01;
    std::array<ValueInterval, 4> read = stored;
    for (std::size_t channel = 0; channel < 4; ++channel) {
        ValueInterval& value = read[channel];
        if (isColor && channel < 3) {
            value = widened({linearOf(value.low), linearOf(value.high)}, kSrgb);
        } else {
            value = widened(value, kFilter);
        }
    }
    return read;
}

}  // namespace glint::gltf
