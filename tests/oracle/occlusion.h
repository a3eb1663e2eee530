// Ambient occlusion by quadrature, and its closed form under a sphere.
#pragma once

#include "oracle/quadrature.h"
#include "oracle/world.h"

namespace glint::oracle {

struct OcclusionSettings {
    double radius = 0.0;  // metres; 0: unlimited
    bool linear = false;  // weight 1 - t / radius of a hit at t, instead of 1
};

// Returns 1 - 1/π ∫ w(t) cos θ dω over the hemisphere about the normal, in all three channels. t is the
// distance of the nearest hit, of its front or its back as `faces` says, and w is 0 beyond the radius.
Estimate openness(const World& world, const Vec3& position, const Vec3& normal,
                  const OcclusionSettings& settings, Faces faces, const Strata& strata, Random& random);

// Returns the same below a sphere that lies completely above the tangent plane: 1 - r² h / d³, where h is the
// height of the centre and d its distance. By Nusselt's analogue, the cap of sine r / d is projected at the
// cosine h / d.
double opennessUnderSphere(const Vec3& position, const Vec3& normal, const Vec3& center, double radius);

}  // namespace glint::oracle
