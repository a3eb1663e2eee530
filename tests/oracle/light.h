// Punctual lights and the shares of them that are visible when they have a size.
#pragma once

#include "gltf/scene.h"
#include "oracle/quadrature.h"
#include "oracle/world.h"

namespace glint::oracle {

// Sizes of lights; 0: points, whose shadows are hard.
struct LightSizes {
    double radius = 0.0;       // metres, of point and spot lights
    double sunDiameter = 0.0;  // radians, of directional lights
};

// The cap of directions that a light fills as seen from a point.
struct LightCap {
    Vec3 direction;  // unit, to the centre
    double halfAngle = 0.0;
    double centerDistance = kInfinity;
    double radius = 0.0;

    // Where a ray in a direction of the cap meets the light.
    double distanceAlong(const Vec3& toLight) const;
};

LightCap lightCap(const Light& light, const LightSizes& sizes, const Vec3& position);

// Irradiance on a surface that faces the light's centre, without shadows: KHR_lights_punctual.
Vec3 irradianceFrom(const Light& light, const Vec3& position);

// The share of the light's solid angle that nothing hides; parts below the horizon of `normal` are hidden.
Estimate visibleShare(const World& world, const LightCap& cap, const Vec3& position, const Vec3& normal,
                      const Strata& strata, Random& random);

// The share of a cap that a plane through its apex leaves which hides what is below it; the plane is at the
// angle `elevation` above the axis. Mazonka, "Solid Angle of Conical Surfaces, Polyhedral Cones, and
// Intersecting Spherical Caps" (2012), the conical segment.
double shareBesidesEdge(double halfAngle, double elevation);

// The share of a cap that another cap leaves whose half angle is `hiding` and whose axis is `apart` from its
// own: what they have in common is two sectors less two spherical triangles (Girard's theorem).
double shareBesidesCap(double halfAngle, double hiding, double apart);

// The share of a cap about the zenith that a horizontal disk leaves, seen from below: `radius` of the disk
// and `aside`, the distance of its middle from the zenith, are over its height. An integral over the cap's
// elevation of the arc that is free, to 1e-6.
double shareBesidesDisk(double halfAngle, double radius, double aside);

}  // namespace glint::oracle
