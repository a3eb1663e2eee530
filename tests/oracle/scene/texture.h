// Textures of a scene in double precision: the finest level, filtered as its sampler magnifies.
#pragma once

#include "gltf/scene.h"
#include "oracle/scene/geometry.h"

#include <array>
#include <optional>

namespace glint::oracle {

// Whether a slot holds colours that the sRGB transfer function encodes: glTF 2.0 and its extensions.
bool isSrgb(const Material& material, TextureSlot slot);

// The UV set that a slot reads, transformed (KHR_texture_transform); nothing where it has no texture, or the
// surface not that set.
std::optional<Vec2> textureCoordinates(const TextureInfo& info, const SurfacePoint& point);

// Linear values of 8-bit sRGB texels.
using SrgbTable = std::array<double, 256>;
// IEC 61966-2-1.
SrgbTable exactSrgb();

class Textures {
public:
    // The images must be decoded. The scene must outlive this.
    Textures(const Scene& scene, const SrgbTable& srgb) : scene_(scene), srgb_(srgb) {}

    const Scene& scene() const {
        return scene_;
    }
    // RGBA in [0, 1], colours linear: texels are decoded first and filtered then. Nothing where there is
    // nothing to read.
    std::optional<glm::dvec4> sample(const Material& material, TextureSlot slot,
                                     const SurfacePoint& point) const;

private:
    const Scene& scene_;
    SrgbTable srgb_;
};

}  // namespace glint::oracle
