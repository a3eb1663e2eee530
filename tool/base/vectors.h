// Conversions between glm, with which the host calculates, and the arrays of scenes and public structures.
#pragma once

#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace glint::base {

template <typename Number>
glm::dvec3 toVector(const std::array<Number, 3>& a) {
    return {a[0], a[1], a[2]};
}

inline std::array<double, 3> toArray(const glm::dvec3& a) {
    return {a.x, a.y, a.z};
}

inline std::array<float, 3> toFloat3(const glm::dvec3& a) {
    return {static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z)};
}

// Both are column-major.
inline glm::dmat4 toMatrix(const std::array<double, 16>& matrix) {
    return glm::make_mat4(matrix.data());
}

inline std::array<double, 16> toArray(const glm::dmat4& matrix) {
    std::array<double, 16> result{};
    std::copy_n(glm::value_ptr(matrix), result.size(), result.begin());
    return result;
}

// Applies the first three rows of a 4 x 4 matrix, which is row-major here.
inline glm::dvec3 transformed(const std::array<float, 12>& rows, const glm::dvec3& point) {
    return glm::transpose(glm::dmat3x4(glm::make_mat3x4(rows.data()))) * glm::dvec4(point, 1.0);
}

// Applies a column-major matrix whose last row is (0, 0, 0, 1).
inline glm::dvec3 transformed(const std::array<double, 16>& matrix, const glm::dvec3& point) {
    return toMatrix(matrix) * glm::dvec4(point, 1.0);
}

template <typename Number, std::size_t N>
bool isFinite(const std::array<Number, N>& value) {
    return std::ranges::all_of(value, [](Number number) { return std::isfinite(number); });
}

}  // namespace glint::base
