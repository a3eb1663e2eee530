// Light that arrives at a surface from everywhere: quadrature and closed forms.
#pragma once

#include "oracle/quadrature.h"
#include "oracle/world.h"

#include <functional>

namespace glint::oracle {

// Returns the radiance that leaves a hit against the ray.
using HitRadiance = std::function<Vec3(const Hit& hit, const Ray& ray)>;
// Returns the radiance of the sky in a direction.
using SkyRadiance = std::function<Vec3(const Vec3& direction)>;

// A sky that is linear in the cosine, from the horizon to the zenith above, and to the ground below.
struct GradientSky {
    Vec3 zenith{0.0};
    Vec3 horizon{0.0};
    Vec3 ground{0.0};

    Vec3 operator()(const Vec3& direction) const;
};

// Returns 1/π ∫ L cos θ dω over the hemisphere about the normal.
Estimate irradianceOverPi(const World& world, const Vec3& position, const Vec3& normal, Faces faces,
                          const HitRadiance& hitRadiance, const SkyRadiance& sky, const Strata& strata,
                          Random& random);

// Returns the cosine-weighted share of a uniform hemisphere that a parallelogram fills: Lambert's formula
// over its edges (as in Baum, Rushmeier and Winget 1989). The parallelogram must lie completely above the
// plane.
double formFactorOfQuad(const Vec3& position, const Vec3& normal, const Vec3& corner, const Vec3& right,
                        const Vec3& up);

}  // namespace glint::oracle
