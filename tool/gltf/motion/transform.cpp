#include "gltf/motion/transform.h"

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace glint::gltf {

Matrix4 compose(const Transform& transform) {
    const auto [x, y, z, w] = transform.rotation;
    glm::dmat4 matrix = glm::mat4_cast(glm::dquat(w, x, y, z));
    for (glm::length_t axis = 0; axis < 3; ++axis) {
        matrix[axis] *= transform.scale[static_cast<std::size_t>(axis)];
    }
    matrix[3] = glm::dvec4(base::toVector(transform.translation), 1.0);
    return base::toArray(matrix);
}

Matrix4 instanceTransform(const Instancing& instancing, std::size_t index) {
    Transform transform;
    if (!instancing.translations.empty()) {
        std::ranges::copy(instancing.translations[index], transform.translation.begin());
    }
    if (!instancing.rotations.empty()) {
        std::ranges::copy(instancing.rotations[index], transform.rotation.begin());
    }
    if (!instancing.scales.empty()) {
        std::ranges::copy(instancing.scales[index], transform.scale.begin());
    }
    return compose(transform);
}

std::vector<Matrix4> placesOf(const Scene& scene, const Node& node) {
    if (node.mesh < 0 || !node.shown) {
        return {};
    }
    if (node.instancing < 0) {
        return {node.world};
    }
    const Instancing& instancing = scene.instancings[static_cast<std::size_t>(node.instancing)];
    std::vector<Matrix4> places;
    places.reserve(instancing.count);
    for (std::size_t i = 0; i < instancing.count; ++i) {
        places.push_back(multiply(node.world, instanceTransform(instancing, i)));
    }
    return places;
}

bool clearProjection(Matrix4& matrix) {
    const bool isClear = matrix[3] == 0.0 && matrix[7] == 0.0 && matrix[11] == 0.0 && matrix[15] == 1.0;
    matrix[3] = matrix[7] = matrix[11] = 0.0;
    matrix[15] = 1.0;
    return isClear;
}

bool fitsFloat(const Matrix4& matrix) {
    constexpr double kLargest = std::numeric_limits<float>::max();
    return std::all_of(matrix.begin(), matrix.end(),
                       [](double element) { return std::abs(element) <= kLargest; });
}

std::optional<glm::dvec3> normalized(const glm::dvec3& v) {
    const double length = glm::length(v);
    // A shorter vector has fewer digits as a float, or none at all.
    constexpr double kShortest = std::numeric_limits<float>::min();
    if (!(length >= kShortest) || !std::isfinite(length)) {
        return std::nullopt;
    }
    return v / length;
}

std::optional<Matrix4> rigidPart(const Matrix4& matrix) {
    glm::dmat4 m = base::toMatrix(matrix);
    const auto z = normalized(glm::dvec3(m[2]));
    const auto up = normalized(glm::dvec3(m[1]));
    if (!z || !up) {
        return std::nullopt;
    }
    const auto y = normalized(*up - *z * glm::dot(*up, *z));
    if (!y) {
        return std::nullopt;
    }
    m[0] = glm::dvec4(glm::cross(*y, *z), 0.0);
    m[1] = glm::dvec4(*y, 0.0);
    m[2] = glm::dvec4(*z, 0.0);
    return base::toArray(m);
}

}  // namespace glint::gltf
