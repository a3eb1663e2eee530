// The values that materials read at a point: factors times textures, and the frames of normal textures.
#pragma once

#include "gltf/scene.h"
#include "oracle/scene/texture.h"

#include <array>
#include <string_view>

namespace glint::oracle {

class Inputs {
public:
    // Both must outlive the object.
    Inputs(const Textures& textures, const SurfacePoint& point);

    // Returns white if there is nothing to read.
    glm::dvec4 texel(std::string_view slot) const;
    bool reads(std::string_view slot) const;
    glm::dvec4 baseColor() const;
    // Returns the columns tangent, bitangent and normal. They come from TANGENT, or from the directions in
    // which the coordinates that the slot is read at grow. The bitangent points up in the image
    // (glTF 2.0, 3.7.2.1).
    glm::dmat3 tangentFrame(std::string_view slot) const;
    // Returns the normal of a normal texture, towards the front.
    Vec3 mappedNormal(std::string_view slot, double scale) const;
    // Returns whether anisotropy has a direction.
    bool hasDirection() const;
    // Applies glTF 2.0, 3.9.4, alphaMode MASK.
    bool passesAlphaMask() const;

    const materials::Material& material() const {
        return material_;
    }
    const SurfacePoint& point() const {
        return point_;
    }

private:
    std::array<Vec2, 2> derivedEdges(std::string_view slot) const;

    const Textures& textures_;
    const SurfacePoint& point_;
    const materials::Material& material_;
};

}  // namespace glint::oracle
