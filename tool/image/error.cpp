#include "image/error.h"

#include "image/flip.h"
#include "image/tone.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace glint::image {

namespace {

// Bounds the weight of dark pixels, as in compareImages().
constexpr double kEpsilon = 0.01;

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
            ofPixel += d * d / (r * r + kEpsilon);
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
