// A reference renderer: direct light of punctual lights with hard shadows, emission, and one mirror
// reflection, in double precision. No light of the sky.
#pragma once

#include "gltf/scene.h"
#include "oracle/irradiance.h"
#include "oracle/world.h"

namespace glint::oracle {

class Reference {
public:
    // Both must outlive it.
    Reference(const Scene& scene, const World& world) : scene_(scene), world_(world) {}

    // Of what a ray meets first, culled; black where it meets nothing. Surfaces that are smoother than
    // `mirrorRoughness` mirror what they see, once.
    Vec3 radiance(const Ray& ray, double mirrorRoughness = 0.0) const;

private:
    Vec3 surface(const Ray& ray, const Hit& hit, double mirrorRoughness) const;

    const Scene& scene_;
    const World& world_;
};

}  // namespace glint::oracle
