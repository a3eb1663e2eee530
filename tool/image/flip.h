// FLIP measures how different two pictures look to somebody who flips between them.
#pragma once

#include "image/png.h"

#include <glint/image.h>

#include <span>
#include <vector>

namespace glint::image {

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
