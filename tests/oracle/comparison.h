// Compares pictures of the device with truths of pixels.
#pragma once

#include "oracle/quadrature.h"
#include "oracle/view.h"

#include <glint/renderer.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace glint::oracle {

struct PixelTruth {
    std::uint32_t x = 0;
    std::uint32_t y = 0;
    Estimate light;
};

// Returns the light along a ray.
using RayLight = std::function<Estimate(const Ray&, Random&)>;
// Returns whether a pixel with this ray is to be compared.
using Selector = std::function<bool(const Ray&)>;

// Returns the truths of the pixels whose rays are all selected. The rays are a grid of 17 × 17 that reaches a
// little beyond the pixel, so details finer than a sixteenth of a pixel may be missed. Each pixel has its own
// random numbers.
std::vector<PixelTruth> pixelTruths(const View& view, const Strata& strata, const Selector& selected,
                                    const RayLight& light);

// Returns truths for the rays through the pixels' centres, where a first sample lies; for light that a ray
// decides. Pixels are left out if the light changes by more than a hundredth, of itself or of 1, within 1/128
// of a pixel: the rasteriser rounds to half of that.
std::vector<PixelTruth> centreTruths(const View& view, const std::function<Vec3(const Ray&)>& light);

// A row of the table in docs/effects_accuracy.md.
struct Subject {
    std::string effect;
    std::string what;            // scene and setting
    std::string truth;           // "quadrature", or the closed form
    std::uint32_t channels = 1;  // 1 where red, green and blue are the same
    std::uint32_t samples = 1;
    // The largest value of a single sample. 0 means that the ray of a sample decides its light; the pixel and
    // its neighbours then tell how far apart samples may be.
    double range = 1.0;
    // How far the mean signed error may exceed its standard error, and any pixel its own bound, because of
    // the stated causes.
    double bias = 0.0;
};

struct Comparison {
    std::size_t pixels = 0;
    double mean = 0.0;     // of the truth
    double largest = 0.0;  // |error|
    double rootMeanSquare = 0.0;
    double expected = 0.0;  // root mean square of independent samples, and of the truth's own error
    // The mean of device - truth in the channel where it is largest, and its standard error.
    double signedMean = 0.0;
    double signedError = 0.0;
    double worst = 0.0;      // largest |error| over the bound of its pixel
    double worstTile = 0.0;  // largest |mean signed error| of a tile over its bound
    // Why the picture does not agree with the truth; empty if it does.
    std::vector<std::string> objections;
};

// Objects in these cases:
// - The worst pixel is off by more than Bernstein's inequality allows the mean of independent samples with
// the
//   truth's variance, one time in 10⁵, plus five standard errors of the truth, plus the bias (scrambled
//   sequences spread less than independent samples).
// - The root mean square error exceeds that of independent samples by more than a fifth, plus the bias.
// - The mean signed error exceeds four of its standard errors, plus the bias. The pixels' spread gives that
//   standard error, because their random numbers are independent.
// - The mean signed error of a tile of 6 × 6 pixels, at least 18 of which are compared, exceeds six of its
//   standard errors, plus the bias. This finds pictures that are too bright here and too dark there, such as
//   a penumbra that is too wide.
// `truths` must not be empty.
Comparison compare(const LinearImage& image, const std::vector<PixelTruth>& truths, const Subject& subject);

// Fails the test for each objection, or if there is nothing to compare. Adds a row to the table.
void expectAgrees(const LinearImage& image, const std::vector<PixelTruth>& truths, const Subject& subject);

}  // namespace glint::oracle
