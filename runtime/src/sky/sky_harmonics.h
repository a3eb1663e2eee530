// The diffuse light of a map in real spherical harmonics.
#pragma once

#include "sky/radiance_map.h"

#include <array>

namespace glint {

// The irradiance over π of a surface with the normal (x, y, z), as a polynomial. It has coefficients of 1, x,
// y, z, 3y² - 1, xy, yz, xz, x² - z², each for red, green and blue.
using SkyHarmonics = std::array<std::array<double, 3>, 9>;

// Returns orders 0 to 2 with the cosine lobe folded in (Ramamoorthi and Hanrahan 2001, "An Efficient
// Representation for Irradiance Environment Maps"). The integrals over each texel are exact.
SkyHarmonics skyHarmonics(const RadianceMap& map);

// Returns the harmonics of the map turned about +Y by `angle` radians, counter-clockwise as seen from above.
SkyHarmonics turned(const SkyHarmonics& harmonics, double angle);

}  // namespace glint
