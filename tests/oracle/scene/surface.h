// A material where a ray meets it, in double precision: textures, the lobes of every extension, and what they
// make of light. The BSDF alone is the shaders' own, compiled as C++ (tests/numerics).
#pragma once

#include "gltf/scene.h"
#include "oracle/irradiance.h"
#include "oracle/scene/texture.h"

#include <memory>
#include <vector>

namespace glint::oracle {

// Base or coat of a mirror, and the light that is seen in it.
struct Mirror {
    Vec3 direction;  // unit
    Vec3 weight;
};

class LitSurface {
public:
    // Seen along `incoming`. Lobes of a roughness of at most `mirrorRoughness` are mirrors; below 0, none is.
    LitSurface(const Textures& textures, const SurfacePoint& point, const Vec3& incoming,
               double mirrorRoughness);
    ~LitSurface();
    LitSurface(const LitSurface&) = delete;
    LitSurface& operator=(const LitSurface&) = delete;

    bool unlit() const;
    Vec3 baseColor() const;
    Vec3 emission() const;
    // BSDF times |cosine|, reflected or let through; 0 where normal and geometric normal disagree about the
    // side of the light.
    Vec3 scattered(const Vec3& toLight) const;
    // Of the sky, as far as no mirror shows it: Glint's approximation (docs/materials.md), as no ray of an
    // effect is behind it.
    Vec3 ambient(const GradientSky& sky) const;
    // Fresnel at the view is a mirror's weight; over the last fifth below the limit the sky takes over
    // (docs/reflections.md).
    std::vector<Mirror> mirrors() const;

    Vec3 normal() const;           // on the viewer's side
    Vec3 geometricNormal() const;  // likewise

private:
    struct Lobes;
    std::unique_ptr<Lobes> lobes_;
};

}  // namespace glint::oracle
