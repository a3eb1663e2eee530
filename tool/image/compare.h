// Measures the difference between two images.
#pragma once

#include "image/png.h"

#include <glint/image.h>
#include <glint/result.h>

#include <cstdint>
#include <string>

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

}  // namespace glint::image
