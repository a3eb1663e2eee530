// Punctual lights, and the visible shares of lights that have a size.
#pragma once

#include "gltf/scene.h"
#include "oracle/quadrature.h"
#include "oracle/world.h"

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
};

LightCap lightCap(const gltf::Light& light, const LightSizes& sizes, const Vec3& position);

// Returns the irradiance on a surface that faces the light's centre, without shadows: KHR_lights_punctual.
Vec3 irradianceFrom(const gltf::Light& light, const Vec3& position);

// Returns the share of the light's solid angle that nothing hides. Parts below the horizon of `normal` are
// hidden.
Estimate visibleShare(const World& world, const LightCap& cap, const Vec3& position, const Vec3& normal,
                      const Strata& strata, Random& random);

// Returns the visible share of a cap if a plane through its apex hides everything below it; the plane is at
// the angle `elevation` above the axis. Mazonka, "Solid Angle of Conical Surfaces, Polyhedral Cones, and
// Intersecting Spherical Caps" (2012), the conical segment.
double shareBesidesEdge(double halfAngle, double elevation);

// Returns the visible share of a cap if another cap hides part of it. The half angle of the other cap is
// `hiding`, and its axis is `apart` from that of the first. Their intersection is two sectors minus two
// spherical triangles (Girard's theorem).
double shareBesidesCap(double halfAngle, double hiding, double apart);

// Returns the visible share of a cap about the zenith if a horizontal disk hides part of it, seen from below.
// `radius` is that of the disk, and `aside` is the distance of its middle from the zenith, both over its
// height. It is an integral of the free arc over the cap's elevation, to 1e-6.
double shareBesidesDisk(double halfAngle, double radius, double aside);

}  // namespace glint::oracle
