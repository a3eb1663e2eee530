// What rough surfaces see of a map: its mean over reflection lobes.
#pragma once

#include "radiance_map.h"

#include <cstdint>
#include <vector>

namespace glint {

// Sizes of the map on the device. Its mips halve; the last one that is used is 32 wide or a little more,
// which is what the lobe of roughness 1 needs, and the smallest map still has four of them.
inline constexpr std::uint32_t kMinMapWidth = 256;
inline constexpr std::uint32_t kMaxMapWidth = 2048;
inline constexpr std::uint32_t kMinMapHeight = 128;
inline constexpr std::uint32_t kMaxMapHeight = 1024;

// The same light within those sizes.
RadianceMap fitToDevice(RadianceMap map);

// How many levels a map of this width has.
std::uint32_t levelCount(std::uint32_t width);

// The map, then a level for each roughness k / (levelCount - 1), of the sizes of a mip chain. A level holds
// the mean of the radiance L over the GGX lobe of a surface seen head on, ∫ L D(h) (n·l) dl / ∫ D(h) (n·l) dl
// with n = v = the texel's direction (Karis 2013, "Real Shading in Unreal Engine 4"). By multiple importance
// sampling of the map and of the lobe (Veach 1997, balance heuristic), so that a sun of a few texels leaves
// no noise. The same for any number of threads. Requires a map that fits the device.
std::vector<RadianceMap> filterByRoughness(RadianceMap map);

}  // namespace glint
