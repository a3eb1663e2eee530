// The vectors of the oracle, in double precision throughout.
#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace glint::oracle {

using Vec2 = glm::dvec2;
using Vec3 = glm::dvec3;

inline constexpr double kPi = std::numbers::pi;

inline double squared(double x) {
    return x * x;
}

template <typename Number, std::size_t n>
glm::vec<n, double> toVec(const std::array<Number, n>& v) {
    glm::vec<n, double> result;
    for (std::size_t i = 0; i < n; ++i) {
        result[static_cast<int>(i)] = v[i];
    }
    return result;
}

// Returns the columns of a frame: two tangents and the axis, which must be a unit vector.
inline glm::dmat3 frameAbout(const Vec3& axis) {
    const Vec3 helper = std::abs(axis.x) < 0.7 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0);
    const Vec3 tangent = glm::normalize(helper - axis * glm::dot(helper, axis));
    return {tangent, glm::cross(axis, tangent), axis};
}

}  // namespace glint::oracle
