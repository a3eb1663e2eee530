#include "image/flip_filters.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glint::image::flip {

namespace {

constexpr double kPi = std::numbers::pi;

// A term a sqrt(π / b) exp(-π² d² / b) over the distance d in degrees. These are the paper's spatial filters,
// with the parameters of its table 1.
struct Term {
    double a;
    double b;
};
constexpr Term kAchromatic{1.0, 0.0047};
constexpr Term kRedGreen{1.0, 0.0053};
constexpr Term kBlueYellowWide{34.1, 0.04};
constexpr Term kBlueYellowNarrow{13.5, 0.025};

// The number of standard deviations that a filter reaches from its middle, as in the paper.
constexpr double kReach = 3.0;
// The distance from the highest to the lowest weight of the edge filter, in degrees: w of the paper's feature
// detection.
constexpr double kEdgeWidth = 0.082;

template <typename Function>
Kernel sample(std::size_t radius, Function function) {
    Kernel kernel(2 * radius + 1);
    for (std::size_t i = 0; i < kernel.size(); ++i) {
        kernel[i] = function(static_cast<double>(i) - static_cast<double>(radius));
    }
    return kernel;
}

// Scales the weights above 0 so that they sum to 1, and those below to -1. Returns the sum of those above
// before scaling.
double normalizeLobes(Kernel& kernel) {
    double above = 0.0;
    double below = 0.0;
    for (const double weight : kernel) {
        (weight > 0.0 ? above : below) += weight;
    }
    for (double& weight : kernel) {
        if (weight != 0.0) {
            weight /= weight > 0.0 ? above : -below;
        }
    }
    return above;
}

// The standard deviation of exp(-π² d² / b) is sqrt(b / (2 π²)).
std::size_t sensitivityRadius(double pixelsPerDegree) {
    const double deviation = std::sqrt(kBlueYellowWide.b / (2.0 * kPi * kPi));
    return static_cast<std::size_t>(std::ceil(kReach * deviation * pixelsPerDegree));
}

Kernel gaussian(const Term& term, double pixelsPerDegree) {
    return sample(sensitivityRadius(pixelsPerDegree), [&](double x) {
        const double degrees = x / pixelsPerDegree;
        return std::exp(-kPi * kPi * degrees * degrees / term.b);
    });
}

}  // namespace

SensitivityFilters sensitivityFilters(double pixelsPerDegree) {
    SensitivityFilters filters{gaussian(kAchromatic, pixelsPerDegree), gaussian(kRedGreen, pixelsPerDegree),
                               gaussian(kBlueYellowWide, pixelsPerDegree),
                               gaussian(kBlueYellowNarrow, pixelsPerDegree)};
    normalizeLobes(filters.achromatic);
    normalizeLobes(filters.redGreen);
    // The paper normalises the sum of both terms over x and y, so each term keeps its share of that sum.
    const auto weight = [](const Term& term, Kernel& kernel) {
        const double sum = normalizeLobes(kernel);
        return term.a * std::sqrt(kPi / term.b) * sum * sum;
    };
    const double wide = weight(kBlueYellowWide, filters.blueYellowWide);
    const double narrow = weight(kBlueYellowNarrow, filters.blueYellowNarrow);
    filters.wideShare = wide / (wide + narrow);
    filters.narrowShare = narrow / (wide + narrow);
    return filters;
}

FeatureFilters featureFilters(double pixelsPerDegree) {
    // The extremes of a Gaussian's first derivative are one standard deviation from its middle.
    const double deviation = 0.5 * kEdgeWidth * pixelsPerDegree;
    const auto radius = static_cast<std::size_t>(std::ceil(kReach * deviation));
    const auto bell = [deviation](double x) { return std::exp(-x * x / (2.0 * deviation * deviation)); };
    FeatureFilters filters{
        sample(radius, bell), sample(radius, [&](double x) { return -x * bell(x); }),
        sample(radius, [&](double x) { return (x * x / (deviation * deviation) - 1.0) * bell(x); })};
    normalizeLobes(filters.smooth);
    normalizeLobes(filters.edge);
    normalizeLobes(filters.point);
    return filters;
}

}  // namespace glint::image::flip
