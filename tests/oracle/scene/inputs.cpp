#include "oracle/scene/inputs.h"

#include <array>
#include <string_view>

namespace glint::oracle {

Inputs::Inputs(const Textures& textures, const SurfacePoint& point)
    : textures_(textures),
      point_(point),
      material_(textures.scene().materials[static_cast<std::size_t>(point.material)]) {}

glm::dvec4 Inputs::texel(std::string_view slot) const {
    return textures_.sample(material_, slot, point_).value_or(glm::dvec4(1.0));
}

bool Inputs::reads(std::string_view slot) const {
    return textureCoordinates(material_.texture(slot), point_).has_value();
}

glm::dvec4 Inputs::baseColor() const {
    const auto& factor = material_["baseColorFactor"];
    return glm::dvec4(factor[0], factor[1], factor[2], factor[3]) * texel("baseColorTexture") * point_.color;
}

glm::dmat3 Inputs::tangentFrame(std::string_view slot) const {
    const Vec3& n = point_.normal;
    Vec3 along(0.0);
    double handedness = point_.handedness;
    if (point_.tangent) {
        along = *point_.tangent;
    } else {
        const std::array<Vec2, 2> uv = derivedEdges(slot);
        const double area = uv[0].x * uv[1].y - uv[0].y * uv[1].x;
        along = (point_.edges[0] * uv[1].y - point_.edges[1] * uv[0].y) * glm::sign(area);
        const Vec3 down = (point_.edges[1] * uv[0].x - point_.edges[0] * uv[1].x) * glm::sign(area);
        handedness = glm::dot(glm::cross(n, along), down) > 0.0 ? -1.0 : 1.0;
    }
    along -= n * glm::dot(n, along);
    if (along == Vec3(0.0)) {
        return frameAbout(n);
    }
    const Vec3 tangent = glm::normalize(along);
    return {tangent, glm::cross(n, tangent) * handedness, n};
}

Vec3 Inputs::mappedNormal(std::string_view slot, double scale) const {
    if (!reads(slot)) {
        return point_.normal;
    }
    const Vec3 stored = Vec3(texel(slot)) * 2.0 - 1.0;
    const Vec3 bent = tangentFrame(slot) * (stored * Vec3(scale, scale, 1.0));
    return bent == Vec3(0.0) ? point_.normal : glm::normalize(bent);
}

bool Inputs::hasDirection() const {
    return point_.tangent || point_.texCoords[0] || point_.texCoords[1];
}

bool Inputs::passesAlphaMask() const {
    return baseColor().a >= material_["alphaCutoff"];
}

// Returns how the coordinates that the slot is read at change along the edges. A slot without a texture has
// those of the first existing set.
std::array<Vec2, 2> Inputs::derivedEdges(std::string_view slot) const {
    if (!reads(slot)) {
        return point_.texCoordEdges[point_.texCoords[0] ? 0 : 1];
    }
    const materials::TextureInfo& info = material_.texture(slot);
    std::array<Vec2, 2> edges = point_.texCoordEdges[static_cast<std::size_t>(info.texCoord)];
    for (Vec2& edge : edges) {
        edge = transformed(edge, info.transform);
    }
    return edges;
}

}  // namespace glint::oracle
