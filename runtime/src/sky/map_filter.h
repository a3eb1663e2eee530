// Filters a map for rough surfaces: its means over reflection lobes.
#pragma once

#include "sky/radiance_map.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace glint {

// A direction x, y, z of the map; a unit vector.
using Direction = std::array<double, 3>;

struct MapSample {
    Direction direction;
    std::size_t texel = 0;
    double pdf = 0.0;  // density per steradian
};

// Inverts the marginal distribution of rows, then the conditional one of columns (Pharr, Jakob and Humphreys
// 2016, section 14.2.4). Solid angles are exact, and the density is uniform within a texel. A black map has a
// uniform distribution.
class MapDistribution {
public:
    explicit MapDistribution(const RadianceMap& map);

    // `row` and `column` must be in [0, 1).
    MapSample sample(double row, double column) const;
    double pdf(std::size_t texel) const {
        return weights_[texel] / total_;
    }

private:
    std::uint32_t width_;
    std::uint32_t height_;
    std::vector<float> weights_;      // luminance, or 1 if the whole map is black
    std::vector<double> rowSums_;     // sums of weight times solid angle of the rows above; height + 1
    std::vector<double> columnSums_;  // sums of weight of the texels to the left; width + 1 for each row
    double total_ = 0.0;
};

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
