// Filters a map for rough surfaces: its means over reflection lobes.
#pragma once

#include "sky/radiance_map.h"

#include <cstdint>
#include <vector>

namespace glint {

// Limits of the map's width on the device. Each mip has half the size of the one before. The last one in use
// is 32 texels wide or a little wider, as the lobe of roughness 1 needs. The smallest map still has four such
// mips.
inline constexpr std::uint32_t kMinMapWidth = 256;
inline constexpr std::uint32_t kMaxMapWidth = 2048;
inline constexpr std::uint32_t kMinMapHeight = 128;
inline constexpr std::uint32_t kMaxMapHeight = 1024;

// Returns a map within those sizes that has the same light.
RadianceMap fitToDevice(RadianceMap map);

// Returns the number of levels of a map of this width.
std::uint32_t levelCount(std::uint32_t width);

// Returns the map, then a level for each roughness k / (levelCount - 1), in the sizes of a mip chain. A level
// holds the mean of the radiance L over the GGX lobe of a surface seen head on, ∫ L D(h) (n·l) dl / ∫ D(h)
// (n·l) dl with n = v = the texel's direction (Karis 2013, "Real Shading in Unreal Engine 4"). The mean uses
// multiple importance sampling of the map and of the lobe (Veach 1997, balance heuristic), so that a sun of a
// few texels leaves no noise. The result does not depend on the number of threads. Requires a map that fits
// the device.
std::vector<RadianceMap> filterByRoughness(RadianceMap map);

}  // namespace glint
