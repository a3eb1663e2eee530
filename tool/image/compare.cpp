#include "image/compare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace glint::image {

namespace {

using Pixel = std::array<float, 4>;

constexpr double kRelMseEpsilon = 0.01;

bool isFinite(const Pixel& pixel) {
    return std::isfinite(pixel[0]) && std::isfinite(pixel[1]) && std::isfinite(pixel[2]);
}

double relativeError(double value, double reference) {
    return std::abs(value - reference) / std::max(1.0, std::abs(reference));
}

void raise(LargestError& largest, double error, std::size_t pixel, std::uint32_t width, int channel) {
    if (error > largest.value) {
        largest = {error, static_cast<std::uint32_t>(pixel % width),
                   static_cast<std::uint32_t>(pixel / width), channel};
    }
}

// Sums over the compared pixels. They are added in the image's order, so that results do not depend on the
// machine.
struct Sums {
    double absolute = 0.0;
    double squared = 0.0;
    double relativeSquared = 0.0;
    double peak = 1.0;
};

void addPixel(const Pixel& pixel, const Pixel& reference, std::size_t index, std::uint32_t width, Sums& sums,
              ImageDifference& difference) {
    bool differs = false;
    for (int channel = 0; channel < 3; ++channel) {
        const auto c = static_cast<std::size_t>(channel);
        const double a = pixel[c];
        const double b = reference[c];
        const double error = std::abs(a - b);
        raise(difference.absolute, error, index, width, channel);
        raise(difference.relative, relativeError(a, b), index, width, channel);
        sums.absolute += error;
        sums.squared += error * error;
        sums.relativeSquared += error * error / (b * b + kRelMseEpsilon);
        sums.peak = std::max(sums.peak, std::abs(b));
        differs = differs || error > 0.0;
    }
    ++difference.pixels;
    difference.differing += differs ? 1 : 0;
}

// The colours of the map, equally spaced over the scale.
constexpr std::array<std::array<float, 3>, 5> kHeat{
    {{0, 0, 4}, {87, 16, 110}, {188, 55, 84}, {249, 142, 9}, {252, 255, 164}}};
constexpr std::array<std::uint8_t, 3> kNonFiniteColor{0, 255, 0};

std::array<std::uint8_t, 3> heat(double error) {
    constexpr double kDecades = 4.0;
    if (!(error > 0.0)) {
        return {0, 0, 0};
    }
    const double along = std::clamp(std::log10(error) / kDecades + 1.0, 0.0, 1.0) * (kHeat.size() - 1);
    const std::size_t stop = std::min(static_cast<std::size_t>(along), kHeat.size() - 2);
    const auto fraction = static_cast<float>(along - static_cast<double>(stop));
    std::array<std::uint8_t, 3> color{};
    for (std::size_t i = 0; i < 3; ++i) {
        const float value = kHeat[stop][i] + (kHeat[stop + 1][i] - kHeat[stop][i]) * fraction;
        color[i] = static_cast<std::uint8_t>(std::lround(value));
    }
    return color;
}

}  // namespace

Result<ImageDifference> compareImages(const LinearImage& image, const LinearImage& reference,
                                      const std::string& imageName, const std::string& referenceName) {
    if (image.width != reference.width || image.height != reference.height) {
        const auto size = [](const LinearImage& i) {
            return std::to_string(i.width) + " x " + std::to_string(i.height);
        };
        return makeError("image-mismatch", imageName,
                         "is " + size(image) + " pixels, but " + referenceName + " is " + size(reference),
                         "compare images of one size");
    }
    ImageDifference difference;
    Sums sums;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const bool finite = isFinite(image.pixels[i]);
        const bool referenceFinite = isFinite(reference.pixels[i]);
        difference.nonFinite += finite ? 0 : 1;
        difference.referenceNonFinite += referenceFinite ? 0 : 1;
        if (finite && referenceFinite) {
            addPixel(image.pixels[i], reference.pixels[i], i, image.width, sums, difference);
        }
    }
    const double values = 3.0 * static_cast<double>(std::max<std::uint64_t>(difference.pixels, 1));
    difference.mean = sums.absolute / values;
    difference.rmse = std::sqrt(sums.squared / values);
    difference.relMse = sums.relativeSquared / values;
    difference.psnr = difference.rmse > 0.0 ? 20.0 * std::log10(sums.peak / difference.rmse)
                                            : std::numeric_limits<double>::infinity();
    return difference;
}

DisplayImage differenceMap(const LinearImage& image, const LinearImage& reference) {
    DisplayImage map{image.width, image.height, {}};
    map.pixels.reserve(image.pixels.size());
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const Pixel& a = image.pixels[i];
        const Pixel& b = reference.pixels[i];
        if (!isFinite(a) || !isFinite(b)) {
            map.pixels.push_back(kNonFiniteColor);
            continue;
        }
        map.pixels.push_back(heat(
            std::max({relativeError(a[0], b[0]), relativeError(a[1], b[1]), relativeError(a[2], b[2])})));
    }
    return map;
}

}  // namespace glint::image
