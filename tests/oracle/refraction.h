// Light through smooth dielectrics: every path of reflections and refractions, weighted by Fresnel, without
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

// Returns the reflectance of an interface from index `from` to index `to`, at the cosine of incidence; 1 for
// total reflection. schlickIor is as in Dielectric.
double reflectance(Fresnel fresnel, double from, double to, double cosine, double schlickIor = 0.0);
// Refracts the unit vector `direction` at an interface whose unit normal points against it. Returns false for
// total reflection.
bool refracted(const Vec3& direction, const Vec3& normal, double from, double to, Vec3& result);

// The properties of a volume's material.
struct Dielectric {
    Vec3 ior{1.5};         // red, green, blue
    Vec3 absorption{0.0};  // per metre
    // The index whose reflectance at normal incidence Schlick's approximation uses for all wavelengths, like
    // glTF's F0; 0 uses each wavelength's own.
    double schlickIor = 0.0;
};
// Returns -ln(attenuationColor) / attenuationDistance.
Vec3 absorptionOf(const Vec3& attenuationColor, double attenuationDistance);

// Returns null for opaque materials.
using DielectricOf = std::function<const Dielectric*(int material)>;

struct RefractionSettings {
    Fresnel fresnel = Fresnel::Schlick;
    int maxInterfaces = 8;    // crossed or reflected at, the first one included
    double minWeight = 1e-6;  // paths of less are left out
};

struct RefractedLight {
    Vec3 radiance{0.0};
    // The mean square of a single path that is chosen at random at each interface except the first, which
    // transmits with the weight 1 - F: radiance² + variance of such a walk.
    Vec3 square{0.0};
    Vec3 left{0.0};  // weight of the paths that were left out
};

// Returns the light that enters a dielectric at `hit`, whose front `ray` met, and comes out elsewhere,
// without the reflection of the first interface. Paths end at opaque hits and in the sky. A hit of a back
// face leaves the medium; a hit of a front face enters one.
RefractedLight refractedLight(const World& world, const Ray& ray, const Hit& hit,
                              const DielectricOf& dielectricOf, const HitRadiance& hitRadiance,
                              const SkyRadiance& sky, const RefractionSettings& settings);

// Returns the light that enters a rough dielectric at `hit` and that its first ray finds within it. It is the
// mean over the visible normals of GGX microfacets (Heitz 2018), each with Fresnel's share, Snell's direction
// and the masking of the way down given that of the way up, height-correlated (Heitz 2014). The ray ends at
// its first hit, which is assumed to be opaque.
Estimate roughlyRefractedLight(const World& world, const Ray& ray, const Hit& hit, double alpha,
                               const Dielectric& dielectric, Fresnel fresnel, const HitRadiance& hitRadiance,
                               const SkyRadiance& sky, const Strata& strata, Random& random);

}  // namespace glint::oracle
