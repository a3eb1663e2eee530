// Three-dimensional vectors of the host, in double precision, and affine transforms of them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace glint::base {

using Double3 = std::array<double, 3>;

inline double dot(const Double3& a, const Double3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline Double3 cross(const Double3& a, const Double3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline Double3 sum(const Double3& a, const Double3& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

inline Double3 difference(const Double3& a, const Double3& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

inline Double3 scaled(const Double3& a, double factor) {
    return {a[0] * factor, a[1] * factor, a[2] * factor};
}

inline double length(const Double3& a) {
    return std::hypot(a[0], a[1], a[2]);
}

inline Double3 toDouble3(const std::array<float, 3>& a) {
    return {a[0], a[1], a[2]};
}

inline std::array<float, 3> toFloat3(const Double3& a) {
    return {static_cast<float>(a[0]), static_cast<float>(a[1]), static_cast<float>(a[2])};
}

// Applies a column-major 4 x 4 matrix whose last row is (0, 0, 0, 1).
inline Double3 transformed(const std::array<double, 16>& matrix, const Double3& point) {
    Double3 result{};
    for (std::size_t row = 0; row < 3; ++row) {
        result[row] = matrix[row] * point[0] + matrix[4 + row] * point[1] + matrix[8 + row] * point[2] +
                      matrix[12 + row];
    }
    return result;
}

// Applies the first three rows of a 4 x 4 matrix, which is row-major here.
inline Double3 transformed(const std::array<float, 12>& rows, const Double3& point) {
    Double3 result{};
    for (std::size_t row = 0; row < 3; ++row) {
        result[row] = dot({rows[4 * row], rows[4 * row + 1], rows[4 * row + 2]}, point) + rows[4 * row + 3];
    }
    return result;
}

template <typename Number, std::size_t N>
bool isFinite(const std::array<Number, N>& value) {
    return std::ranges::all_of(value, [](Number number) { return std::isfinite(number); });
}

}  // namespace glint::base
