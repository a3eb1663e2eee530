// Textures of a scene in double precision: the finest level, filtered as the sampler magnifies.
#pragma once

#include "gltf/scene.h"
#include "oracle/scene/geometry.h"

#include <array>
#include <optional>
#include <string_view>

namespace glint::oracle {

// Returns whether a slot holds colours with the sRGB transfer function: glTF 2.0 and its extensions.
bool isSrgb(const materials::Material& material, std::string_view slot);

// Returns the transformed UVs that a slot reads (KHR_texture_transform), or nothing if it has no texture or
// the surface lacks that set.
std::optional<Vec2> textureCoordinates(const materials::TextureInfo& info, const SurfacePoint& point);
// Scales and turns a difference of UVs as a transform does. The turn is counter-clockwise as seen on the
// image, where v points down.
Vec2 transformed(const Vec2& direction, const materials::TextureTransform& transform);

// The linear values of 8-bit sRGB texels.
using SrgbTable = std::array<double, 256>;
// Returns the table of IEC 61966-2-1.
SrgbTable exactSrgb();

class Textures {
public:
    // The images must be decoded. The scene must outlive the object.
    Textures(const gltf::Scene& scene, const SrgbTable& srgb) : scene_(scene), srgb_(srgb) {}

    const gltf::Scene& scene() const {
        return scene_;
    }
    // Returns RGBA in [0, 1] with linear colours: texels are first decoded, then filtered. Returns nothing if
    // there is nothing to read.
    std::optional<glm::dvec4> sample(const materials::Material& material, std::string_view slot,
                                     const SurfacePoint& point) const;

private:
    const gltf::Scene& scene_;
    SrgbTable srgb_;
};

}  // namespace glint::oracle
