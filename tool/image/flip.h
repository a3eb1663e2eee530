// FLIP: how different two pictures look to somebody who flips between them.
#pragma once

#include "image/png.h"

#include <glint/renderer.h>

#include <span>
#include <vector>

namespace glint {

// Of a display 0.7 m wide with 3840 pixels, seen from 0.7 m: what the paper's results are for.
inline constexpr double kFlipPixelsPerDegree = 67.0;

// For each pixel, first row on top, how different it looks, from 0 (not at all) to 1 (as pure blue and pure
// green; black and white are 0.97 apart): LDR-FLIP of Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström
// and Fairchild 2020, "FLIP: A Difference Evaluator for Alternating Images". Takes pictures as a display
// shows them, in linear light (displayedImage() in image/tone.h makes them); values are clamped to [0, 1],
// NaN to 0. Symmetric in the two pictures. Beyond their borders pictures go on with the pixel of the border.
// Requires equal sizes and 1 to 1000 pixels a degree. The radius of the filters is 0.14 degrees; time grows
// with pixels times radius, memory with width times radius.
std::vector<float> flipMap(const LinearImage& image, const LinearImage& reference,
                           double pixelsPerDegree = kFlipPixelsPerDegree);

// The mean of a map, summed in its order; 0 of none. What is quoted as "FLIP" of two pictures.
double flipMean(std::span<const float> map);

}  // namespace glint
