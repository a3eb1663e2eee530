// The filters of FLIP, each a product of a function of x and one of y.
#pragma once

#include <cstddef>
#include <vector>

namespace glint::flip {

// Weights from -radius to radius.
using Kernel = std::vector<double>;

// Contrast sensitivity of the eye: a sum of Gaussians for each channel of YCxCz. That of the blue-yellow
// channel has two terms, of these shares of the sum.
struct SensitivityFilters {
    Kernel achromatic;
    Kernel redGreen;
    Kernel blueYellowWide;
    Kernel blueYellowNarrow;
    double wideShare = 1.0;
    double narrowShare = 0.0;
};
// All of one radius, each of sum 1.
SensitivityFilters sensitivityFilters(double pixelsPerDegree);

// Edges and points: derivatives of a Gaussian in one direction, the Gaussian in the other.
struct FeatureFilters {
    Kernel smooth;  // of sum 1
    Kernel edge;    // first derivative: weights above 0 sum to 1, those below to -1
    Kernel point;   // second derivative, likewise
};
// All of one radius.
FeatureFilters featureFilters(double pixelsPerDegree);

inline std::size_t radiusOf(const Kernel& kernel) {
    return kernel.size() / 2;
}

}  // namespace glint::flip
