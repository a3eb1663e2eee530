// Samples directions in proportion to the luminance of a map.
#pragma once

#include "sky/radiance_map.h"

#include <array>
#include <cstddef>
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

}  // namespace glint
