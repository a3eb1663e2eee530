// A reference renderer in double precision: direct light of punctual lights with hard shadows, emission, and
// one mirror reflection. It has no light from the sky.
#pragma once

#include "gltf/scene.h"
#include "oracle/irradiance.h"
#include "oracle/world.h"

namespace glint::oracle {

class Reference {
public:
    // Both must outlive the object.
    Reference(const gltf::Scene& scene, const World& world) : scene_(scene), world_(world) {}

    // Returns the radiance of the first surface that a ray meets, with back faces culled; black if it meets
    // nothing. Surfaces that are smoother than `mirrorRoughness` reflect once.
    Vec3 radiance(const Ray& ray, double mirrorRoughness = 0.0) const;

private:
    Vec3 surface(const Ray& ray, const Hit& hit, double mirrorRoughness) const;

    const gltf::Scene& scene_;
    const World& world_;
};

}  // namespace glint::oracle
