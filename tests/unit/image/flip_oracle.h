// A second implementation of LDR-FLIP, as slow and as plain as its definition: filters of two dimensions,
// doubles throughout.
#pragma once

#include <glint/renderer.h>

#include <vector>

namespace glint::testing {

// Returns the same as flipMap() of image/compare.h, from the formulas of Andersson and others 2020.
std::vector<double> plainFlip(const LinearImage& image, const LinearImage& reference, double pixelsPerDegree);

}  // namespace glint::testing
