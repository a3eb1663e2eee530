#include "scene/instance_math.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace glint {
namespace {

using Double3 = std::array<double, 3>;

Double3 column(const Rows& rows, std::size_t index) {
    return {rows[index], rows[4 + index], rows[8 + index]};
}

Double3 row(const Rows& rows, std::size_t index) {
    return {rows[4 * index], rows[4 * index + 1], rows[4 * index + 2]};
}

Double3 cross(const Double3& a, const Double3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double dot(const Double3& a, const Double3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

double determinant(const Rows& rows) {
    return dot(row(rows, 0), cross(row(rows, 1), row(rows, 2)));
}

}  // namespace

bool isInvertible(const Rows& objectToWorld) {
    if (!std::ranges::all_of(objectToWorld, [](float value) { return std::isfinite(value); })) {
        return false;
    }
    const double volume = std::abs(determinant(objectToWorld));
    double box = 1.0;
    for (std::size_t i = 0; i < 3; ++i) {
        const Double3 axis = column(objectToWorld, i);
        const double length = std::sqrt(dot(axis, axis));
        // This bounds the inverse of a plain scale: a factor of 1e-30 has the inverse 1e30.
        if (length < 1e-30) {
            return false;
        }
        box *= length;
    }
    // The ratio of both is the volume that the columns would span if their lengths were 1. It bounds what a
    // shear adds to the inverse.
    return volume > 1e-12 * box;
}

gpu::InstanceRecord makeInstanceRecord(const Rows& objectToWorld) {
    gpu::InstanceRecord record{};
    std::array<Double3, 3> cofactors{};
    double largest = 0.0;
    const double sign = determinant(objectToWorld) < 0.0 ? -1.0 : 1.0;
    for (std::size_t i = 0; i < 3; ++i) {
        record.objectToWorld[i] = {objectToWorld[4 * i], objectToWorld[4 * i + 1], objectToWorld[4 * i + 2],
                                   objectToWorld[4 * i + 3]};
        cofactors[i] = cross(row(objectToWorld, (i + 1) % 3), row(objectToWorld, (i + 2) % 3));
        for (const double value : cofactors[i]) {
            largest = std::max(largest, std::abs(value));
        }
    }
    // Only the direction matters. A power of two brings the largest component to [1, 2) without rounding.
    const double scale = largest > 0.0 ? std::exp2(-std::floor(std::log2(largest))) : 1.0;
    for (std::size_t i = 0; i < 3; ++i) {
        record.normalToWorld[i] = {static_cast<float>(sign * scale * cofactors[i][0]),
                                   static_cast<float>(sign * scale * cofactors[i][1]),
                                   static_cast<float>(sign * scale * cofactors[i][2])};
    }
    record.flags = sign < 0.0 ? gpu::kInstanceMirrored : 0;
    return record;
}

gpu::LightRecord makeLightRecord(const LightView& light) {
    const double cosInner = std::cos(static_cast<double>(light.innerConeAngle));
    const double cosOuter = std::cos(static_cast<double>(light.outerConeAngle));
    const double scale = 1.0 / std::max(0.001, cosInner - cosOuter);
    gpu::LightRecord record{};
    record.position = toVec3(light.position);
    record.type = static_cast<std::uint32_t>(light.type);
    record.direction = toVec3(light.direction);
    record.range = light.range;
    record.intensity = toVec3(light.intensity);
    record.spotScale = static_cast<float>(scale);
    record.spotOffset = static_cast<float>(-cosOuter * scale);
    record.size = light.type == LightView::Type::Directional ? std::sin(light.size) : light.size;
    return record;
}

}  // namespace glint
