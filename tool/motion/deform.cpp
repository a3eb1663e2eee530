#include "motion/deform.h"

#include "base/vectors.h"

#include <algorithm>

namespace glint {

namespace {

Double3 transformed(const Matrix4& matrix, const Double3& point) {
    Double3 result{};
    for (std::size_t row = 0; row < 3; ++row) {
        result[row] = matrix[row] * point[0] + matrix[4 + row] * point[1] + matrix[8 + row] * point[2] +
                      matrix[12 + row];
    }
    return result;
}

Double3 skinned(const SkinInfluences& influences, std::size_t vertex, const Double3& point,
                std::span<const Matrix4> joints) {
    Double3 sum{};
    for (std::size_t i = vertex * influences.count; i < (vertex + 1) * influences.count; ++i) {
        if (influences.weights[i] == 0.0F) {
            continue;
        }
        const Double3 moved = transformed(joints[influences.joints[i]], point);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            sum[axis] += influences.weights[i] * moved[axis];
        }
    }
    return sum;
}

}  // namespace

bool isDeformed(const Scene& scene, const Node& node) {
    if (node.mesh < 0) {
        return false;
    }
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(node.mesh)];
    return std::ranges::any_of(mesh.primitives, [&](const Primitive& primitive) {
        return !primitive.targets.empty() || (node.skin >= 0 && primitive.influences.count > 0);
    });
}

bool hasDeformedMesh(const Scene& scene) {
    return std::ranges::any_of(scene.nodes, [&](const Node& node) { return isDeformed(scene, node); });
}

std::vector<Double3> deformedPositions(const Primitive& primitive, std::span<const double> weights,
                                       std::span<const Matrix4> joints) {
    std::vector<Double3> positions;
    positions.reserve(primitive.positions.size());
    const std::size_t targets = std::min(primitive.targets.size(), weights.size());
    const bool follows = primitive.influences.count > 0 && !joints.empty();
    for (std::size_t vertex = 0; vertex < primitive.positions.size(); ++vertex) {
        const Float3& base = primitive.positions[vertex];
        Double3 point{base[0], base[1], base[2]};
        for (std::size_t target = 0; target < targets; ++target) {
            const std::vector<Float3>& differences = primitive.targets[target].positions;
            for (std::size_t axis = 0; axis < 3 && !differences.empty(); ++axis) {
                point[axis] += weights[target] * differences[vertex][axis];
            }
        }
        positions.push_back(follows ? skinned(primitive.influences, vertex, point, joints) : point);
    }
    return positions;
}

}  // namespace glint
