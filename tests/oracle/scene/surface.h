// A material where a ray meets it, in double precision: textures, the lobes of every extension, and how they
// scatter light. Only the BSDF is the shaders' own, compiled as C++ (tests/numerics).
#pragma once

#include "gltf/scene.h"
#include "oracle/irradiance.h"
#include "oracle/scene/texture.h"

#include <memory>
#include <vector>

namespace glint::oracle {

// The base or the coat as a mirror, and the light that it shows.
struct Mirror {
    Vec3 direction;  // unit
    Vec3 weight;
};

class LitSurface {
public:
    // The surface is seen along `incoming`. Lobes with a roughness of at most `mirrorRoughness` are mirrors;
    // if it is below 0, none is.
    LitSurface(const Textures& textures, const SurfacePoint& point, const Vec3& incoming,
               double mirrorRoughness);
    ~LitSurface();
    LitSurface(const LitSurface&) = delete;
    LitSurface& operator=(const LitSurface&) = delete;

    bool unlit() const;
    Vec3 baseColor() const;
    Vec3 emission() const;
    // Returns the BSDF times |cosine|, reflected or transmitted; 0 if normal and geometric normal disagree
    // about the side of the light.
    Vec3 scattered(const Vec3& toLight) const;
    // Returns the sky's light that no mirror shows: Glint's approximation (docs/materials.md), without rays
    // of any effect.
    Vec3 ambient(const GradientSky& sky) const;
    // A mirror's weight is Fresnel at the view. Over the last fifth below the limit the sky takes over
    // (docs/reflections.md).
    std::vector<Mirror> mirrors() const;

    Vec3 normal() const;           // on the viewer's side
    Vec3 geometricNormal() const;  // on the viewer's side

private:
    struct Lobes;
    std::unique_ptr<Lobes> lobes_;
};

}  // namespace glint::oracle
