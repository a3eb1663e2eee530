// The filters of FLIP. Each is a product of a function of x and a function of y.
#pragma once

#include <cstddef>
#include <vector>

namespace glint::image::flip {

// The weights from -radius to radius.
using Kernel = std::vector<double>;

// The contrast sensitivity of the eye: a sum of Gaussians for each channel of YCxCz. The blue-yellow channel
// has two terms, with these shares of the sum.
struct SensitivityFilters {
    Kernel achromatic;
    Kernel redGreen;
    Kernel blueYellowWide;
    Kernel blueYellowNarrow;
    double wideShare = 1.0;
    double narrowShare = 0.0;
};
// Returns filters that have one radius and sum to 1 each.
SensitivityFilters sensitivityFilters(double pixelsPerDegree);

// The filters of edges and points: derivatives of a Gaussian in one direction, and the Gaussian in the other.
struct FeatureFilters {
    Kernel smooth;  // sums to 1
    Kernel edge;    // first derivative: weights above 0 sum to 1, those below to -1
    Kernel point;   // second derivative, normalised like the edge filter
};
// Returns filters that have one radius.
FeatureFilters featureFilters(double pixelsPerDegree);

inline std::size_t radiusOf(const Kernel& kernel) {
    return kernel.size() / 2;
}

}  // namespace glint::image::flip
