#include "gltf/document/repair.h"

#include "base/vectors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace glint::gltf {

namespace {

constexpr const char* kRepairHint = "repair the mesh, or export it again";

glm::dvec3 subtract(const Float3& a, const Float3& b) {
    return base::toVector(a) - base::toVector(b);
}

// Returns a vector of unit length, or nothing if the vector is zero or not finite. Doubles can hold the
// squares of all floats. Products of two squared floats underflow only far below what a float can hold.
std::optional<Float3> unitVector(const glm::dvec3& v) {
    const double largest = std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
    if (!std::isfinite(largest) || largest == 0.0) {
        return std::nullopt;
    }
    const Float3 unit = base::toFloat3(glm::normalize(v / largest));
    return base::isFinite(unit) ? std::optional(unit) : std::nullopt;
}

void dropBrokenTriangles(Document& document, Primitive& primitive) {
    std::vector<bool> broken(primitive.positions.size());
    std::size_t brokenCount = 0;
    for (std::size_t i = 0; i < primitive.positions.size(); ++i) {
        if (!base::isFinite(primitive.positions[i])) {
            broken[i] = true;
            primitive.positions[i] = {};
            ++brokenCount;
        }
    }
    if (brokenCount == 0) {
        return;
    }
    std::vector<std::uint32_t> kept;
    kept.reserve(primitive.indices.size());
    const auto& indices = primitive.indices;
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        if (!broken[indices[i]] && !broken[indices[i + 1]] && !broken[indices[i + 2]]) {
            kept.insert(kept.end(), {indices[i], indices[i + 1], indices[i + 2]});
        }
    }
    const std::size_t dropped = (indices.size() - kept.size()) / 3;
    primitive.indices = std::move(kept);
    document.warn("position-not-finite", primitive.pointer + "/attributes/POSITION",
                  fmt::format("{} positions are not finite; {} triangles that use them are dropped",
                              brokenCount, dropped),
                  kRepairHint);
}

// Returns the geometric normal of one triangle around each vertex that `wanted` marks, or +Z if there is
// none.
std::vector<Float3> adjacentNormals(const Primitive& primitive, const std::vector<bool>& wanted) {
    std::vector<Float3> normals(primitive.positions.size(), Float3{0.0F, 0.0F, 1.0F});
    std::vector<bool> found(primitive.positions.size());
    const auto& indices = primitive.indices;
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        const Float3& origin = primitive.positions[indices[i]];
        const auto normal = unitVector(glm::cross(subtract(primitive.positions[indices[i + 1]], origin),
                                                  subtract(primitive.positions[indices[i + 2]], origin)));
        for (std::size_t corner = i; normal && corner < i + 3; ++corner) {
            const std::uint32_t vertex = indices[corner];
            if (wanted[vertex] && !found[vertex]) {
                found[vertex] = true;
                normals[vertex] = *normal;
            }
        }
    }
    return normals;
}

void repairNormals(Document& document, Primitive& primitive) {
    std::vector<bool> broken(primitive.normals.size());
    std::size_t count = 0;
    for (std::size_t i = 0; i < primitive.normals.size(); ++i) {
        const auto unit = unitVector(base::toVector(primitive.normals[i]));
        broken[i] = !unit;
        count += unit ? 0 : 1;
        primitive.normals[i] = unit.value_or(Float3{});
    }
    if (count == 0) {
        return;
    }
    const std::vector<Float3> substitutes = adjacentNormals(primitive, broken);
    for (std::size_t i = 0; i < broken.size(); ++i) {
        if (broken[i]) {
            primitive.normals[i] = substitutes[i];
        }
    }
    document.warn("normal-invalid", primitive.pointer + "/attributes/NORMAL",
                  fmt::format("{} normals are zero or not finite; that of a triangle beside is used", count),
                  kRepairHint);
}

// Returns a unit vector at right angles to `normal`.
Float3 anyTangent(const Float3& normal) {
    const glm::dvec3 n = base::toVector(normal);
    const glm::dvec3 axis = std::abs(n[0]) < 0.5 ? glm::dvec3{1.0, 0.0, 0.0} : glm::dvec3{0.0, 1.0, 0.0};
    return unitVector(glm::cross(axis, n)).value_or(Float3{1.0F, 0.0F, 0.0F});
}

void repairTangents(Document& document, Primitive& primitive) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < primitive.tangents.size(); ++i) {
        const Float4 stored = primitive.tangents[i];
        const auto unit = unitVector({stored[0], stored[1], stored[2]});
        const Float3 tangent = unit ? *unit : anyTangent(primitive.normals[i]);
        const bool valid = unit.has_value() && std::abs(stored[3]) == 1.0F;
        count += valid ? 0 : 1;
        primitive.tangents[i] = {tangent[0], tangent[1], tangent[2], stored[3] < 0.0F ? -1.0F : 1.0F};
    }
    if (count > 0) {
        document.warn(
            "tangent-invalid", primitive.pointer + "/attributes/TANGENT",
            fmt::format("{} tangents are zero or not finite, or have a w other than 1 and -1; others in the "
                        "surface are used, and the sign of w",
                        count),
            kRepairHint);
    }
}

template <std::size_t N>
void replaceNonFinite(Document& document, const Primitive& primitive,
                      std::vector<std::array<float, N>>& values, float substitute, const char* attribute) {
    std::size_t count = 0;
    for (std::array<float, N>& value : values) {
        if (!base::isFinite(value)) {
            value.fill(substitute);
            ++count;
        }
    }
    if (count > 0) {
        document.warn("attribute-not-finite", fmt::format("{}/attributes/{}", primitive.pointer, attribute),
                      fmt::format("{} values are not finite; {} is used", count, substitute), kRepairHint);
    }
}

// Values of packs' attributes, one by one.
void repairDeclared(Document& document, Primitive& primitive) {
    for (VertexValues& attribute : primitive.attributes) {
        std::size_t count = 0;
        for (float& value : attribute.values) {
            count += std::isfinite(value) ? 0 : 1;
            value = std::isfinite(value) ? value : 0.0F;
        }
        if (count > 0) {
            document.warn("attribute-not-finite",
                          fmt::format("{}/attributes/{}", primitive.pointer, attribute.name),
                          fmt::format("{} values are not finite; 0 is used", count), kRepairHint);
        }
    }
}

}  // namespace

void repairPrimitive(Document& document, Primitive& primitive) {
    dropBrokenTriangles(document, primitive);
    repairNormals(document, primitive);
    repairTangents(document, primitive);
    replaceNonFinite(document, primitive, primitive.texCoords0, 0.0F, "TEXCOORD_0");
    replaceNonFinite(document, primitive, primitive.texCoords1, 0.0F, "TEXCOORD_1");
    replaceNonFinite(document, primitive, primitive.colors, 1.0F, "COLOR_0");
    repairDeclared(document, primitive);
    for (MorphTarget& target : primitive.targets) {
        replaceNonFinite(document, primitive, target.positions, 0.0F, "POSITION of a morph target");
        replaceNonFinite(document, primitive, target.normals, 0.0F, "NORMAL of a morph target");
        replaceNonFinite(document, primitive, target.tangents, 0.0F, "TANGENT of a morph target");
        replaceNonFinite(document, primitive, target.colors, 0.0F, "COLOR_0 of a morph target");
    }
}

}  // namespace glint::gltf
