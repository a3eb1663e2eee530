#include "data/motion_bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace glint {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Box boxOf(const std::array<float, 3>& point) {
    return {{point[0], point[1], point[2]}, {point[0], point[1], point[2]}};
}

// Returns the box around p + sum of weight * difference, for every point p of `box` and any differences in
// their ranges.
Box morphed(Box box, std::span<const Box> targets, std::span<const float> weights) {
    for (std::size_t i = 0; i < std::min(targets.size(), weights.size()); ++i) {
        for (std::size_t axis = 0; axis < 3 && !targets[i].isEmpty(); ++axis) {
            const double a = weights[i] * targets[i].min[axis];
            const double b = weights[i] * targets[i].max[axis];
            box.min[axis] += std::min(a, b);
            box.max[axis] += std::max(a, b);
        }
    }
    return box;
}

}  // namespace

Box Box::nothing() {
    return {{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
}

void Box::extend(const Box& other) {
    for (std::size_t i = 0; i < 3; ++i) {
        min[i] = std::min(min[i], other.min[i]);
        max[i] = std::max(max[i], other.max[i]);
    }
}

bool Box::isEmpty() const {
    return !(min[0] <= max[0] && min[1] <= max[1] && min[2] <= max[2]);
}

double Box::surface() const {
    if (isEmpty()) {
        return 0.0;
    }
    const double x = max[0] - min[0];
    const double y = max[1] - min[1];
    const double z = max[2] - min[2];
    return 2.0 * (x * y + y * z + z * x);
}

double Box::diagonal() const {
    return isEmpty() ? 0.0 : std::hypot(max[0] - min[0], max[1] - min[1], max[2] - min[2]);
}

std::array<double, 3> Box::centre() const {
    return {0.5 * (min[0] + max[0]), 0.5 * (min[1] + max[1]), 0.5 * (min[2] + max[2])};
}

Box transformed(const Box& box, const std::array<float, 12>& rows) {
    if (box.isEmpty()) {
        return box;
    }
    // The method is that of Arvo, "Transforming Axis-Aligned Bounding Boxes" (Graphics Gems, 1990).
    Box result{};
    for (std::size_t row = 0; row < 3; ++row) {
        result.min[row] = result.max[row] = rows[4 * row + 3];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double a = rows[4 * row + axis] * box.min[axis];
            const double b = rows[4 * row + axis] * box.max[axis];
            result.min[row] += std::min(a, b);
            result.max[row] += std::max(a, b);
        }
    }
    return result;
}

MotionBounds::MotionBounds(std::span<const PrimitiveView> primitives) {
    for (const PrimitiveView& primitive : primitives) {
        Part& part = parts_.emplace_back();
        std::map<std::uint32_t, Box> joints;
        const std::size_t vertices = primitive.positions.size();
        const std::size_t influences = vertices == 0 ? 0 : primitive.joints.size() / vertices;
        for (std::size_t vertex = 0; vertex < vertices; ++vertex) {
            const Box point = boxOf(primitive.positions[vertex]);
            part.rest.extend(point);
            for (std::size_t i = vertex * influences; i < (vertex + 1) * influences; ++i) {
                if (primitive.jointWeights[i] > 0.0F) {
                    joints.try_emplace(primitive.joints[i], Box::nothing()).first->second.extend(point);
                }
            }
        }
        for (const auto& [joint, box] : joints) {
            part.joints.push_back({joint, box});
        }
        for (const PrimitiveView::MorphTarget& target : primitive.targets) {
            Box range = Box::nothing();
            for (const std::array<float, 3>& difference : target.positions) {
                range.extend(boxOf(difference));
            }
            part.targets.push_back(range);
        }
    }
}

Box MotionBounds::at(const InstanceView& instance) const {
    Box bounds = Box::nothing();
    for (const Part& part : parts_) {
        if (part.joints.empty() || instance.joints.empty()) {
            bounds.extend(morphed(part.rest, part.targets, instance.morphWeights));
            continue;
        }
        for (const JointBox& joint : part.joints) {
            const Box box = morphed(joint.box, part.targets, instance.morphWeights);
            bounds.extend(transformed(box, instance.joints[joint.joint]));
        }
    }
    return transformed(bounds, instance.objectToWorld);
}

bool hasLeft(const Box& built, const Box& now) {
    if (built.isEmpty() || now.isEmpty()) {
        return built.isEmpty() != now.isEmpty();
    }
    const std::array<double, 3> from = built.centre();
    const std::array<double, 3> to = now.centre();
    return std::hypot(to[0] - from[0], to[1] - from[1], to[2] - from[2]) > built.diagonal();
}

BuildAction BlasHistory::next(bool deformed, double surfaceNow) const {
    if (!deformed) {
        return BuildAction::Keep;
    }
    const bool worn = refits >= kMaxRefits || surfaceNow > kMaxGrowth * surface;
    return worn ? BuildAction::Build : BuildAction::Refit;
}

void BlasHistory::apply(BuildAction action, double surfaceNow) {
    if (action == BuildAction::Refit) {
        ++refits;
    } else if (action == BuildAction::Build) {
        refits = 0;
        surface = surfaceNow;
    }
}

}  // namespace glint
