// Surfaces under light in double precision: the shaders' own BSDF, compiled as C++ (tests/numerics), with
// what the factors of a glTF material make of it. For scenes whose pictures need a whole renderer as their
// truth.
#pragma once

#include "oracle/world.h"
#include "plan/material.h"

namespace glint::oracle {

// A hit with its material: metallic-roughness, emissive strength, ior, specular, clearcoat, sheen; of unlit
// materials the colour alone. Textures are not read. Energy compensation is on, as it is by default.
class Shading {
public:
    Shading(const Material& material, const Hit& hit, const Vec3& incoming);

    bool unlit() const {
        return material_.unlit;
    }
    // COLOR_0 counts.
    Vec3 baseColor() const;
    Vec3 emission() const;
    // BSDF times the cosine, for light from a direction; 0 where normal and geometric normal disagree about
    // its side.
    Vec3 scattered(const Vec3& toLight) const;
    // Of a smooth surface without coat or sheen: Schlick's Fresnel at the view, and where it reflects to.
    Vec3 mirrored(Vec3& direction) const;
    // On the viewer's side.
    Vec3 normal() const {
        return frame_[2];
    }
    Vec3 geometricNormal() const {
        return geometricNormal_;
    }

private:
    // Schlick's, of the coat's index 1.5.
    double reflectedByCoat() const;

    const Material& material_;
    Vec3 color_;
    glm::dmat3 frame_;
    Vec3 geometricNormal_;
    Vec3 view_;  // in the frame
};

}  // namespace glint::oracle
