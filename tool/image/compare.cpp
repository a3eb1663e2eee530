#include "image/compare.h"

#include "image/tone.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

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

namespace {

// The share of pixels that are inliers; the pixels with larger errors are outliers.
constexpr double kInliers = 0.999;

struct Tail {
    double percentile = 0.0;  // the largest error of the inliers
    double mean = 0.0;        // of the inliers
};

Tail tailOf(std::vector<double> values) {
    if (values.empty()) {
        return {};
    }
    const auto rank = static_cast<std::size_t>(std::ceil(kInliers * static_cast<double>(values.size())));
    const auto inliers = static_cast<std::ptrdiff_t>(std::clamp<std::size_t>(rank, 1, values.size()));
    std::ranges::nth_element(values, values.begin() + inliers - 1);
    const double sum = std::accumulate(values.begin(), values.begin() + inliers, 0.0);
    return {values[static_cast<std::size_t>(inliers) - 1], sum / static_cast<double>(inliers)};
}

// Summarises the errors that `difference` returns for a pixel and channel.
template <typename Difference>
ImageErrors summarize(const LinearImage& reference, double scale, const Difference& difference) {
    double relative = 0.0;
    double squared = 0.0;
    double signedSum = 0.0;
    double light = 0.0;
    std::vector<double> pixels;
    pixels.reserve(reference.pixels.size());
    for (std::size_t i = 0; i < reference.pixels.size(); ++i) {
        double ofPixel = 0.0;
        for (std::size_t c = 0; c < 3; ++c) {
            const double r = scale * reference.pixels[i][c];
            const double d = scale * difference(i, c);
            ofPixel += d * d / (r * r + kRelMseEpsilon);
            squared += d * d;
            signedSum += d;
            light += r;
        }
        relative += ofPixel;
        pixels.push_back(ofPixel / 3.0);
    }
    const double count = 3.0 * static_cast<double>(std::max<std::size_t>(reference.pixels.size(), 1));
    ImageErrors errors;
    errors.relMse = relative / count;
    errors.rmse = std::sqrt(squared / count);
    errors.psnr =
        errors.rmse > 0.0 ? -20.0 * std::log10(errors.rmse) : std::numeric_limits<double>::infinity();
    const Tail tail = tailOf(std::move(pixels));
    errors.p999 = std::sqrt(tail.percentile);
    errors.trimmed = tail.mean;
    errors.bias = light > 0.0 ? signedSum / light : 0.0;
    return errors;
}

}  // namespace

ImageErrors measureErrors(const LinearImage& image, const LinearImage& reference, double exposure) {
    ImageErrors errors = summarize(reference, std::exp2(exposure), [&](std::size_t i, std::size_t c) {
        return double{image.pixels[i][c]} - double{reference.pixels[i][c]};
    });
    errors.flip = flipMean(flipMap(displayedImage(image, exposure), displayedImage(reference, exposure)));
    return errors;
}

LinearImage exposed(const LinearImage& image, double exposure) {
    LinearImage result = image;
    const auto scale = static_cast<float>(std::exp2(exposure));
    for (std::array<float, 4>& pixel : result.pixels) {
        for (std::size_t c = 0; c < 3; ++c) {
            pixel[c] *= scale;
        }
    }
    return result;
}

MeanImage::MeanImage(std::uint32_t width, std::uint32_t height)
    : width_(width),
      height_(height),
      mean_(std::size_t{width} * height),
      squares_(std::size_t{width} * height) {}

void MeanImage::add(const LinearImage& block) {
    ++blocks_;
    for (std::size_t i = 0; i < mean_.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            const double value = block.pixels[i][c];
            const double before = value - mean_[i][c];
            mean_[i][c] += before / blocks_;
            squares_[i][c] += before * (value - mean_[i][c]);
        }
    }
}

LinearImage MeanImage::mean() const {
    LinearImage image{width_, height_, {}};
    image.pixels.reserve(mean_.size());
    for (const std::array<double, 3>& pixel : mean_) {
        image.pixels.push_back(
            {static_cast<float>(pixel[0]), static_cast<float>(pixel[1]), static_cast<float>(pixel[2]), 1.0F});
    }
    return image;
}

LinearImage MeanImage::standardError() const {
    LinearImage image{width_, height_, {}};
    image.pixels.reserve(squares_.size());
    const double divisor = static_cast<double>(blocks_) * (blocks_ - 1.0);
    for (const std::array<double, 3>& pixel : squares_) {
        const auto error = [divisor](double squares) {
            return static_cast<float>(std::sqrt(squares / divisor));
        };
        image.pixels.push_back({error(pixel[0]), error(pixel[1]), error(pixel[2]), 1.0F});
    }
    return image;
}

MeanImage MeanImage::restore(const LinearImage& mean, const LinearImage& error, std::uint32_t blocks) {
    MeanImage image(mean.width, mean.height);
    image.blocks_ = blocks;
    const double factor = static_cast<double>(blocks) * (blocks - 1.0);
    for (std::size_t i = 0; i < mean.pixels.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            image.mean_[i][c] = mean.pixels[i][c];
            image.squares_[i][c] = factor * error.pixels[i][c] * error.pixels[i][c];
        }
    }
    return image;
}

ImageErrors noiseOf(const LinearImage& mean, const LinearImage& standardError, double exposure) {
    return summarize(mean, std::exp2(exposure),
                     [&](std::size_t i, std::size_t c) { return double{standardError.pixels[i][c]}; });
}

}  // namespace glint::image
