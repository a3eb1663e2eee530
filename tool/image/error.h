// How far a picture is off a converged one: the measures of glint bench.
#pragma once

#include <glint/renderer.h>
#include <glint/result.h>

#include <cstdint>
#include <vector>

namespace glint {

// All but `flip` in linear light, over red, green and blue, of pictures times 2^exposure: 1 is white and 0.18
// mid-grey. d: picture - reference, r: reference.
struct ImageErrors {
    double relMse = 0.0;  // mean of d² / (r² + 0.01), as compareImages()
    double rmse = 0.0;    // sqrt(mean of d²)
    double psnr = 0.0;    // decibels, -20 log10(rmse): against white; infinite where rmse is 0
    // 99.9th percentile over pixels of sqrt(mean over channels of d² / (r² + 0.01)).
    double p999 = 0.0;
    // As relMse, without the 0.1 % of pixels that are worst: what fireflies leave of it.
    double trimmed = 0.0;
    // Mean of d over mean of r: light that is added (> 0) or lost.
    double bias = 0.0;
    // Mean LDR-FLIP, 0 to 1, of both as a PNG shows them (image/flip.h).
    double flip = 0.0;
};

// Of equal sizes, without NaN or infinity, which a Renderer never gives. `exposure`: stops.
ImageErrors measureErrors(const LinearImage& image, const LinearImage& reference, double exposure);

// Times 2^exposure.
LinearImage exposed(const LinearImage& image, double exposure);

// The mean of pictures and how certain it is, from blocks with random numbers of their own.
class MeanImage {
public:
    MeanImage(std::uint32_t width, std::uint32_t height);

    // Of the same size.
    void add(const LinearImage& block);
    // Of two blocks or more.
    std::uint32_t blocks() const {
        return blocks_;
    }
    LinearImage mean() const;
    // Of the mean, by channel: from the variance between blocks. Needs two of them.
    LinearImage standardError() const;

    // As they were kept; `error` as standardError() gave it.
    static MeanImage restore(const LinearImage& mean, const LinearImage& error, std::uint32_t blocks);

private:
    std::uint32_t width_;
    std::uint32_t height_;
    std::uint32_t blocks_ = 0;
    // Welford's running mean and sum of squared deviations.
    std::vector<std::array<double, 3>> mean_;
    std::vector<std::array<double, 3>> squares_;
};

// What errors a picture without any would have against a mean that is not exact: relMSE and RMSE of its
// standard error.
ImageErrors noiseOf(const LinearImage& mean, const LinearImage& standardError, double exposure);

}  // namespace glint
