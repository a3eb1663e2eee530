#include "gltf/motion/transform.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace glint::gltf {

Matrix4 identity() {
    return {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
}

Matrix4 multiply(const Matrix4& a, const Matrix4& b) {
    Matrix4 product{};
    for (std::size_t column = 0; column < 4; ++column) {
        for (std::size_t row = 0; row < 4; ++row) {
            for (std::size_t k = 0; k < 4; ++k) {
                product[4 * column + row] += a[4 * k + row] * b[4 * column + k];
            }
        }
    }
    return product;
}

Matrix4 compose(const base::Double3& translation, const std::array<double, 4>& rotation,
                const base::Double3& scale) {
    const auto [x, y, z, w] = rotation;
    const auto [sx, sy, sz] = scale;
    return {(1 - 2 * (y * y + z * z)) * sx,
            2 * (x * y + w * z) * sx,
            2 * (x * z - w * y) * sx,
            0,
            2 * (x * y - w * z) * sy,
            (1 - 2 * (x * x + z * z)) * sy,
            2 * (y * z + w * x) * sy,
            0,
            2 * (x * z + w * y) * sz,
            2 * (y * z - w * x) * sz,
            (1 - 2 * (x * x + y * y)) * sz,
            0,
            translation[0],
            translation[1],
            translation[2],
            1};
}

Matrix4 instanceTransform(const Instancing& instancing, std::size_t index) {
    base::Double3 translation{};
    std::array<double, 4> rotation{0.0, 0.0, 0.0, 1.0};
    base::Double3 scale{1.0, 1.0, 1.0};
    if (!instancing.translations.empty()) {
        std::copy_n(instancing.translations[index].begin(), 3, translation.begin());
    }
    if (!instancing.rotations.empty()) {
        std::copy_n(instancing.rotations[index].begin(), 4, rotation.begin());
    }
    if (!instancing.scales.empty()) {
        std::copy_n(instancing.scales[index].begin(), 3, scale.begin());
    }
    return compose(translation, rotation, scale);
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

bool fitsFloat(const Matrix4& matrix) {
    constexpr double kLargest = std::numeric_limits<float>::max();
    return std::all_of(matrix.begin(), matrix.end(),
                       [](double element) { return std::abs(element) <= kLargest; });
}

std::optional<base::Double3> normalized(const base::Double3& v) {
    const double length = std::hypot(v[0], v[1], v[2]);
    // A shorter vector has fewer digits as a float, or none at all.
    constexpr double kShortest = std::numeric_limits<float>::min();
    if (!(length >= kShortest) || !std::isfinite(length)) {
        return std::nullopt;
    }
    return base::Double3{v[0] / length, v[1] / length, v[2] / length};
}

std::optional<Matrix4> rigidPart(const Matrix4& m) {
    const auto z = normalized({m[8], m[9], m[10]});
    const base::Double3 up{m[4], m[5], m[6]};
    const auto upDirection = normalized(up);
    if (!z || !upDirection) {
        return std::nullopt;
    }
    const double along =
        (*upDirection)[0] * (*z)[0] + (*upDirection)[1] * (*z)[1] + (*upDirection)[2] * (*z)[2];
    const auto y = normalized({(*upDirection)[0] - along * (*z)[0], (*upDirection)[1] - along * (*z)[1],
                               (*upDirection)[2] - along * (*z)[2]});
    if (!y) {
        return std::nullopt;
    }
    const base::Double3 x{(*y)[1] * (*z)[2] - (*y)[2] * (*z)[1], (*y)[2] * (*z)[0] - (*y)[0] * (*z)[2],
                          (*y)[0] * (*z)[1] - (*y)[1] * (*z)[0]};
    return Matrix4{x[0],    x[1],    x[2],    0, (*y)[0], (*y)[1], (*y)[2], 0,
                   (*z)[0], (*z)[1], (*z)[2], 0, m[12],   m[13],   m[14],   1};
}

}  // namespace glint::gltf
