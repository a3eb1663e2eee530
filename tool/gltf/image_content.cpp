#include "gltf/image_content.h"

#include <algorithm>
#include <cmath>

namespace glint::gltf {

namespace {

using materials::ValueInterval;

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

double numberAsRead(double stored, bool isColor) {
    return isColor ? linearOf(stored) : stored;
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
