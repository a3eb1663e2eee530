// Light through smooth dielectrics: every path of reflections and refractions, weighed by Fresnel, none by
// chance.
#pragma once

#include "oracle/irradiance.h"
#include "oracle/world.h"

#include <functional>

namespace glint::oracle {

enum class Fresnel {
    Schlick,  // glTF 2.0, appendix B; from the denser side by the transmitted angle, with total reflection
    Exact     // the unpolarised dielectric
};

// Of an interface from index `from` to index `to`, at the cosine of incidence; 1 where reflection is total.
// schlickIor: as in Dielectric.
double reflectance(Fresnel fresnel, double from, double to, double cosine, double schlickIor = 0.0);
// Unit `direction` through an interface whose unit normal is against it; false where reflection is total.
bool refracted(const Vec3& direction, const Vec3& normal, double from, double to, Vec3& result);

// What a material of a volume is made of.
struct Dielectric {
    Vec3 ior{1.5};         // red, green, blue
    Vec3 absorption{0.0};  // per metre
    // Index whose reflectance at normal incidence Schlick's approximation has for all wavelengths, as glTF's
    // F0 has; 0: each wavelength's own.
    double schlickIor = 0.0;
};
// -ln(attenuationColor) / attenuationDistance.
Vec3 absorptionOf(const Vec3& attenuationColor, double attenuationDistance);

// Null for materials that are opaque.
using DielectricOf = std::function<const Dielectric*(int material)>;

struct RefractionSettings {
    Fresnel fresnel = Fresnel::Schlick;
    int maxInterfaces = 8;    // crossed or reflected at, the first one included
    double minWeight = 1e-6;  // paths of less are left out
};

struct RefractedLight {
    Vec3 radiance{0.0};
    // Mean of the square of one path chosen by chance at each interface but the first, which lets through
    // with the weight 1 - F: radiance² + variance of such a walk.
    Vec3 square{0.0};
    Vec3 left{0.0};  // weight of the paths that were left out
};

// What enters a dielectric at `hit`, whose front `ray` met, and comes out elsewhere: without what the first
// interface reflects. Paths end at opaque hits and in the sky. A hit of a back leaves the medium, of a front
// enters one.
RefractedLight refractedLight(const World& world, const Ray& ray, const Hit& hit,
                              const DielectricOf& dielectricOf, const HitRadiance& hitRadiance,
                              const SkyRadiance& sky, const RefractionSettings& settings);

// What enters a rough dielectric at `hit` and is found within it by its first ray: the mean over the visible
// normals of GGX microfacets (Heitz 2018), each with Fresnel's share, Snell's direction and the masking of
// the way down given that of the way up, height-correlated (Heitz 2014). The ray is not followed beyond what
// it meets, which is taken to be opaque.
Estimate roughlyRefractedLight(const World& world, const Ray& ray, const Hit& hit, double alpha,
                               const Dielectric& dielectric, Fresnel fresnel, const HitRadiance& hitRadiance,
                               const SkyRadiance& sky, const Strata& strata, Random& random);

}  // namespace glint::oracle
