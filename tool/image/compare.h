// Measures the difference between two images, and the error of a picture against a converged one.
#pragma once

#include "image/png.h"

#include <glint/image.h>
#include <glint/result.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace glint::image {

// The largest error of a kind, and the first place where it occurs.
struct LargestError {
    double value = 0.0;
    std::uint32_t x = 0;  // pixels from the left
    std::uint32_t y = 0;  // pixels from the top
    int channel = 0;      // 0 red, 1 green, 2 blue
};

// The errors over the red, green and blue values a of the image and b of the reference, in linear light.
// Pixels in which either image has a NaN or an infinity are counted and left out of everything else.
struct ImageDifference {
    LargestError absolute;        // |a - b|
    LargestError relative;        // |a - b| / max(1, |b|)
    double mean = 0.0;            // of |a - b|
    double rmse = 0.0;            // sqrt(mean of (a - b)²)
    double relMse = 0.0;          // mean of (a - b)² / (b² + 0.01)
    double psnr = 0.0;            // decibels, 20 log10(max(1, largest |b|) / rmse); infinite if rmse is 0
    std::uint64_t pixels = 0;     // compared pixels
    std::uint64_t differing = 0;  // compared pixels that are not exactly equal
    std::uint64_t nonFinite = 0;  // pixels in which the image has a NaN or an infinity
    std::uint64_t referenceNonFinite = 0;  // the same for the reference
};

// Compares two images; the names are for messages. relMSE, with its epsilon of 0.01 that bounds the weight of
// dark pixels, is that of Rousselle, Knaus and Zwicker 2011, "Adaptive Sampling and Reconstruction using
// Greedy Error Minimization". Error "image-mismatch" if the sizes differ.
Result<ImageDifference> compareImages(const LinearImage& image, const LinearImage& reference,
                                      const std::string& imageName, const std::string& referenceName);

// Returns a map that shows the largest relative error of each pixel as a colour on a logarithmic scale: black
// for errors up to 1e-4, then violet, red and orange to pale yellow for 1 and above; green if either image
// has a NaN or an infinity. Requires equal sizes.
DisplayImage differenceMap(const LinearImage& image, const LinearImage& reference);

// --- Measures the error of a picture against a converged one, for glint bench ---

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
    // Mean LDR-FLIP, 0 to 1, of both pictures as a PNG shows them (flipMap()).
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

// --- FLIP: how different two pictures look to somebody who flips between them ---

// A display 0.7 m wide with 3840 pixels, seen from 0.7 m; the paper's results are for it.
inline constexpr double kFlipPixelsPerDegree = 67.0;

// Returns for each pixel, top row first, its perceived difference, from 0 (none) to 1 (as pure blue and pure
// green; black and white are 0.97 apart). This is LDR-FLIP of Andersson, Nilsson, Akenine-Möller, Oskarsson,
// Åström and Fairchild 2020, "FLIP: A Difference Evaluator for Alternating Images". It takes pictures as a
// display shows them, in linear light (displayedImage() in image/tone.h makes them). Values are clamped to
// [0, 1], and NaN becomes 0. The result is symmetric in the two pictures. Beyond their borders, pictures
// continue with the border's pixels. Requires equal sizes and 1 to 1000 pixels a degree. The radius of the
// filters is 0.14 degrees; time grows with pixels times radius, memory with width times radius.
std::vector<float> flipMap(const LinearImage& image, const LinearImage& reference,
                           double pixelsPerDegree = kFlipPixelsPerDegree);

// Returns the mean of a map, summed in its order, or 0 for an empty map. This is the number that is quoted as
// the "FLIP" of two pictures.
double flipMean(std::span<const float> map);

}  // namespace glint::image
