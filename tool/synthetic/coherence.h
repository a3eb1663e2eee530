// How alike the hits of neighbouring rays are.
#pragma once

#include "synthetic/cases_scene.h"

#include <cstdint>

namespace glint::synthetic {

// The chance that two hits of 32 rays that follow each other in the list are of the same case, beyond that of
// any two hits: (a - r) / (1 - r) with a = the former and r = the sum of squared shares. 0: as in random
// order; 1: all alike, as of one case. The form is that of Cohen's kappa ("A coefficient of agreement for
// nominal scales", 1960).
//
// Computed from the geometry, not read from a device: rays of a mirror as its law has them through the
// middle of each pixel, others by random numbers of its own. 32 rays in a row are a block of 8 x 4 pixels,
// as a subgroup of 32 appends them; of large pictures a part of the blocks is looked at.
double coherentShareOf(const CasesOptions& options, std::uint32_t width, std::uint32_t height);

}  // namespace glint::synthetic
