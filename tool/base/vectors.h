// Three-dimensional vectors of the host, in double precision.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace glint {

using Double3 = std::array<double, 3>;

inline double dot(const Double3& a, const Double3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline Double3 cross(const Double3& a, const Double3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline Double3 scaled(const Double3& a, double factor) {
    return {a[0] * factor, a[1] * factor, a[2] * factor};
}

template <std::size_t N>
bool isFinite(const std::array<float, N>& value) {
    return std::ranges::all_of(value, [](float number) { return std::isfinite(number); });
}

}  // namespace glint
