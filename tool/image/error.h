// Measures the error of a picture against a converged one, for glint bench.
#pragma once

#include <glint/image.h>
#include <glint/result.h>

#include <cstdint>
#include <vector>

namespace glint::image {

// All members except `flip` are in linear light, over red, green and blue, of pictures times 2^exposure: 1 is
// white and 0.18 mid-grey. d is picture - reference, and r is reference.
struct ImageErrors {
    double relMse = 0.0;  // mean of d² / (r² + 0.01), as in compareImages()
    double rmse = 0.0;    // sqrt(mean of d²)
    double psnr = 0.0;    // decibels, -20 log10(rmse), relative to white; infinite if rmse is 0
    // 99.9th percentile over pixels of sqrt(mean over channels of d² / (r² + 0.01)).
    double p999 = 0.0;
    // relMse without the worst 0.1 % of the pixels, so that fireflies count little.
    double trimmed = 0.0;
    // Mean of d over mean of r. Above 0 light is added, below 0 light is lost.
    double bias = 0.0;
    // Mean LDR-FLIP, 0 to 1, of both pictures as a PNG shows them (image/flip.h).
    double flip = 0.0;
};

// Requires pictures of equal sizes without NaN or infinity, which a Renderer never gives. `exposure` is in
// stops.
ImageErrors measureErrors(const LinearImage& image, const LinearImage& reference, double exposure);

// Returns the image times 2^exposure.
LinearImage exposed(const LinearImage& image, double exposure);

// The mean of pictures and its uncertainty, from blocks that have independent random numbers.
class MeanImage {
public:
    MeanImage(std::uint32_t width, std::uint32_t height);

    // All blocks must have the same size.
    void add(const LinearImage& block);
    // Returns the number of blocks so far.
    std::uint32_t blocks() const {
        return blocks_;
    }
    LinearImage mean() const;
    // Returns the standard error of the mean, by channel, from the variance between blocks. Requires at least
    // two blocks.
    LinearImage standardError() const;

    // Restores a stored mean; `error` is the result of standardError().
    static MeanImage restore(const LinearImage& mean, const LinearImage& error, std::uint32_t blocks);

private:
    std::uint32_t width_;
    std::uint32_t height_;
    std::uint32_t blocks_ = 0;
    // Welford's running mean and sum of squared deviations.
    std::vector<std::array<double, 3>> mean_;
    std::vector<std::array<double, 3>> squares_;
};

// Returns the errors that a perfect picture would have against an inexact mean: the relMSE and RMSE of its
// standard error.
ImageErrors noiseOf(const LinearImage& mean, const LinearImage& standardError, double exposure);

}  // namespace glint::image
