// Punctual lights, and the light of those that have a size. These shine equally in all directions: a sphere,
// or a disk infinitely far away.
#pragma once

#include "gltf/scene.h"
#include "oracle/quadrature.h"
#include "oracle/world.h"

#include <functional>

namespace glint::oracle {

// The sizes of lights. 0 means a point, whose shadows are hard.
struct LightSizes {
    double radius = 0.0;       // metres, of point and spot lights
    double sunDiameter = 0.0;  // radians, of directional lights
};

// The cap of directions that a light fills, seen from a point.
struct LightCap {
    Vec3 direction;  // unit, to the centre
    double halfAngle = 0.0;
    double centerDistance = kInfinity;
    double radius = 0.0;

    // Returns where a ray in a direction of the cap meets the light.
    double distanceAlong(const Vec3& toLight) const;
    // Returns the mean radiance over the cap times its solid angle, over the irradiance on a surface that
    // faces its centre: 2 π (1 - cos a) / (π sin² a).
    double overFacing() const {
        return 2.0 / (1.0 + std::cos(halfAngle));
    }
};

LightCap lightCap(const gltf::Light& light, const LightSizes& sizes, const Vec3& position);

// Returns the irradiance on a surface that faces the light's centre, without shadows: KHR_lights_punctual. It
// is the same for every size.
Vec3 irradianceFrom(const gltf::Light& light, const Vec3& position);

// The BSDF times the cosine, or another weight of light from a direction.
using Scattered = std::function<Vec3(const Vec3& toLight)>;

// Returns the weighted light of all points of a cap that nothing hides, over the irradiance on a surface that
// faces its centre.
Estimate lightOfCap(const World& world, const LightCap& cap, const Vec3& position, const Scattered& scattered,
                    const Strata& strata, Random& random);
// The same, weighted by the cosine on the side of the normal.
Estimate irradianceOfCap(const World& world, const LightCap& cap, const Vec3& position, const Vec3& normal,
                         const Strata& strata, Random& random);

// The directions within an angle of an axis.
struct Circle {
    Vec3 axis;  // unit
    double halfAngle = 0.0;
};

// Returns ∫ ω dω over the directions that are within both circles: ½ ∮ ω × dω along the arcs of its boundary
// (Stokes; as in Arvo, "Applications of Irradiance Tensors", 1995). Its dot product with the normal of a
// surface is the irradiance of these directions, if all of them are above the surface.
Vec3 vectorIrradiance(const Circle& first, const Circle& second);

// Returns the irradiance of a light on a surface that may hide part of it, over that on a surface which faces
// it.
double irradianceAboveHorizon(const Circle& light, const Vec3& normal);
// The same of a light that is above the horizon, if another circle hides part of it.
double irradianceBesides(const Circle& light, const Circle& hiding, const Vec3& normal);

// The same of a light about the zenith, if a horizontal disk hides part of it, seen from below. `radius` is
// that of the disk, and `aside` is the distance of its middle from the zenith, both over its height. It is an
// integral of the free arc over the light's elevation, to 1e-6.
double irradianceBesidesDisk(double halfAngle, double radius, double aside);

}  // namespace glint::oracle
