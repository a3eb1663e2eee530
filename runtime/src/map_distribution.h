// Directions by importance: in proportion to the luminance of a map.
#pragma once

#include "radiance_map.h"

#include <array>
#include <cstddef>
#include <vector>

namespace glint {

// A direction of the map, x, y, z, unit.
using Direction = std::array<double, 3>;

struct MapSample {
    Direction direction;
    std::size_t texel = 0;
    double pdf = 0.0;  // per steradian
};

// The marginal distribution of rows and the conditional ones of columns, inverted in turn (Pharr, Jakob and
// Humphreys 2016, section 14.2.4), with exact solid angles: uniform within a texel. Of a black map: uniform.
class MapDistribution {
public:
    explicit MapDistribution(const RadianceMap& map);

    // `row` and `column` in [0, 1).
    MapSample sample(double row, double column) const;
    double pdf(std::size_t texel) const {
        return weights_[texel] / total_;
    }

private:
    std::uint32_t width_;
    std::uint32_t height_;
    std::vector<float> weights_;      // luminance, or 1 if all is black
    std::vector<double> rowSums_;     // of weight times solid angle, of the rows above; height + 1
    std::vector<double> columnSums_;  // of weight, of the texels to the left; width + 1 for each row
    double total_ = 0.0;
};

}  // namespace glint
