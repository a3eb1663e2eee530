#include "data/instance_math.h"

#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>

namespace glint {
namespace {

// The linear part. Columns of the matrix are the rows of the transform.
glm::dmat3 linearRows(const Rows& rows) {
    return glm::dmat3(glm::make_mat3x4(rows.data()));
}

}  // namespace

bool isInvertible(const Rows& objectToWorld) {
    if (!isFinite(objectToWorld)) {
        return false;
    }
    const glm::dmat3 linear = glm::transpose(linearRows(objectToWorld));
    const double volume = std::abs(glm::determinant(linear));
    double box = 1.0;
    for (glm::length_t i = 0; i < 3; ++i) {
        const double length = glm::length(linear[i]);
        // This bounds the inverse of a plain scale: a factor of 1e-30 has the inverse 1e30.
        if (length < 1e-30) {
            return false;
        }
        box *= length;
    }
    // The ratio of both is the volume that the columns would span if their lengths were 1. It bounds the
    // effect of a shear on the inverse.
    return volume > 1e-12 * box;
}

gpu::InstanceRecord makeInstanceRecord(const Rows& objectToWorld) {
    gpu::InstanceRecord record{};
    const glm::dmat3 rows = linearRows(objectToWorld);
    glm::dmat3 cofactors{};
    double largest = 0.0;
    const double sign = glm::determinant(rows) < 0.0 ? -1.0 : 1.0;
    for (glm::length_t i = 0; i < 3; ++i) {
        const auto row = 4 * static_cast<std::size_t>(i);
        record.objectToWorld[i] = {objectToWorld[row], objectToWorld[row + 1], objectToWorld[row + 2],
                                   objectToWorld[row + 3]};
        cofactors[i] = glm::cross(rows[(i + 1) % 3], rows[(i + 2) % 3]);
        const glm::dvec3 size = glm::abs(cofactors[i]);
        largest = std::max({largest, size.x, size.y, size.z});
    }
    // Only the direction matters. A power of two brings the largest component to [1, 2) without rounding.
    const double scale = largest > 0.0 ? std::exp2(-std::floor(std::log2(largest))) : 1.0;
    for (glm::length_t i = 0; i < 3; ++i) {
        const glm::vec3 normal(sign * scale * cofactors[i]);
        record.normalToWorld[i] = {normal.x, normal.y, normal.z};
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

std::vector<gpu::LightRecord> makeLightRecords(std::span<const LightView> lights) {
    std::vector<gpu::LightRecord> records;
    records.reserve(lights.size());
    std::ranges::transform(lights, std::back_inserter(records), makeLightRecord);
    return records;
}

}  // namespace glint
