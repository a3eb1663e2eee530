#include "gltf/derived_tangents.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace glint::gltf {

namespace {

// What single precision rounds in a unit vector.
constexpr double kDerivedError = 2.5e-7;

using Vector = std::array<double, 3>;

Vector difference(const Float3& a, const Float3& b) {
    return {double{a[0]} - b[0], double{a[1]} - b[1], double{a[2]} - b[2]};
}

Vector crossProduct(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double dotProduct(const Vector& a, const Vector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// Returns x * a + y * b.
Vector combined(const Vector& a, double x, const Vector& b, double y) {
    return {x * a[0] + y * b[0], x * a[1] + y * b[1], x * a[2] + y * b[2]};
}

bool derivesOn(const Primitive& primitive, const std::vector<Float2>& texCoords,
               const std::uint32_t* corners) {
    const Float3& origin = primitive.positions[corners[0]];
    const Vector edge1 = difference(primitive.positions[corners[1]], origin);
    const Vector edge2 = difference(primitive.positions[corners[2]], origin);
    const Vector plane = crossProduct(edge1, edge2);
    if (dotProduct(plane, plane) == 0.0) {
        return true;
    }
    const auto uvEdge = [&](int corner, std::size_t axis) {
        return double{texCoords[corners[corner]][axis]} - texCoords[corners[0]][axis];
    };
    const double determinant = uvEdge(1, 0) * uvEdge(2, 1) - uvEdge(1, 1) * uvEdge(2, 0);
    if (determinant == 0.0 || !std::isfinite(determinant)) {
        return false;
    }
    const double sign = determinant > 0.0 ? 1.0 : -1.0;
    const Vector along = combined(edge1, uvEdge(2, 1) * sign, edge2, -uvEdge(1, 1) * sign);
    const Vector alongV = combined(edge2, uvEdge(1, 0) * sign, edge1, -uvEdge(2, 0) * sign);
    const double length = std::sqrt(dotProduct(along, along));
    for (int i = 0; i < 3; ++i) {
        const Float4& tangent = primitive.tangents[corners[i]];
        const Float3& normal = primitive.normals[corners[i]];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            // Not a number is no tangent that is derived.
            if (!(std::abs(tangent[axis] - along[axis] / length) <= kDerivedError)) {
                return false;
            }
        }
        const double turn = dotProduct(crossProduct({normal[0], normal[1], normal[2]}, along), alongV);
        if (turn == 0.0 || (turn > 0.0 ? -1.0F : 1.0F) != tangent[3]) {
            return false;
        }
    }
    return true;
}

bool derivesFrom(const Primitive& primitive, const std::vector<Float2>& texCoords) {
    for (std::size_t i = 0; i + 2 < primitive.indices.size(); i += 3) {
        if (!derivesOn(primitive, texCoords, &primitive.indices[i])) {
            return false;
        }
    }
    return true;
}

}  // namespace

bool derivesTangents(const Primitive& primitive) {
    const bool isDeformed = !primitive.targets.empty() || primitive.influences.count > 0;
    if (primitive.tangents.empty() || primitive.normals.empty() || isDeformed ||
        (primitive.texCoords0.empty() && primitive.texCoords1.empty())) {
        return false;
    }
    return (primitive.texCoords0.empty() || derivesFrom(primitive, primitive.texCoords0)) &&
           (primitive.texCoords1.empty() || derivesFrom(primitive, primitive.texCoords1));
}

}  // namespace glint::gltf
