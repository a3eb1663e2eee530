// Surfaces under light in double precision: the shaders' own BSDF, compiled as C++ (tests/numerics), with
// parameters from the factors of a glTF material. It is for scenes whose truth needs a whole renderer.
#pragma once

#include "materials/material.h"
#include "oracle/world.h"

namespace glint::oracle {

// A hit with its material: metallic-roughness, emissive strength, ior, specular, clearcoat, sheen; for unlit
// materials only the colour. Textures are not read. Energy compensation is on, which is the default.
class Shading {
public:
    Shading(const materials::Material& material, const Hit& hit, const Vec3& incoming);

    bool unlit() const {
        return material_.isUnlit();
    }
    // COLOR_0 is a factor.
    Vec3 baseColor() const;
    Vec3 emission() const;
    // Returns the BSDF times the cosine, for light from a direction; 0 if normal and geometric normal
    // disagree about its side.
    Vec3 scattered(const Vec3& toLight) const;
    // Returns Schlick's Fresnel at the view for a smooth surface without coat or sheen, and sets the
    // direction of reflection.
    Vec3 mirrored(Vec3& direction) const;
    // Returns the normal on the viewer's side.
    Vec3 normal() const {
        return frame_[2];
    }
    Vec3 geometricNormal() const {
        return geometricNormal_;
    }

private:
    // Returns Schlick's approximation for the coat's index 1.5.
    double reflectedByCoat() const;

    const materials::Material& material_;
    Vec3 color_;
    glm::dmat3 frame_;
    Vec3 geometricNormal_;
    Vec3 view_;  // in the frame
};

}  // namespace glint::oracle
