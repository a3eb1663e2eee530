// Measures the similarity of neighbouring rays' hits.
#pragma once

#include "synthetic/cases_scene.h"

#include <cstdint>

namespace glint::synthetic {

// Returns by how much two hits of 32 successive rays of the list are likelier of the same case than any two
// hits: (a - r) / (1 - r), where a is that chance and r is the sum of squared shares. 0 means random order; 1
// means that all hits are alike, or that there is one case. The form is that of Cohen's kappa ("A coefficient
// of agreement for nominal scales", 1960).
//
// It is computed from the geometry, not read from a device. Rays of a mirror follow the law of reflection
// through the middle of each pixel; other rays use random numbers of this function's own. 32 rays in a row
// are a block of 8 x 4 pixels, as a subgroup of 32 appends them. In large pictures only some of the blocks
// are evaluated.
double coherentShareOf(const CasesOptions& options, std::uint32_t width, std::uint32_t height);

}  // namespace glint::synthetic
