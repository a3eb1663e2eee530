// Diffuse light of a map by real spherical harmonics.
#pragma once

#include "radiance_map.h"

#include <array>

namespace glint {

// Irradiance over π of a surface with the normal (x, y, z), as a polynomial: the coefficients of 1, x, y, z,
// 3y² - 1, xy, yz, xz, x² - z². For each, red, green, blue.
using SkyHarmonics = std::array<std::array<double, 3>, 9>;

// Orders 0 to 2 with the cosine lobe folded in (Ramamoorthi and Hanrahan 2001, "An Efficient Representation
// for Irradiance Environment Maps"). The integrals over each texel are exact.
SkyHarmonics skyHarmonics(const RadianceMap& map);

// Of the map turned about +Y by `angle`, counter-clockwise as seen from above, radians.
SkyHarmonics turned(const SkyHarmonics& harmonics, double angle);

}  // namespace glint
