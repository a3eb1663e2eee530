// Expectations about estimates.
#pragma once

#include "oracle/quadrature.h"

#include <gtest/gtest.h>

namespace glint::oracle {

// Expects that the estimate's mean is within five of its standard errors of the truth, and that this error is
// at most `largest`. The spread of four repeats has three degrees of freedom, for which Student's t exceeds 5
// with a probability of 1.5 %; seeds are fixed. `floor` bounds further known errors.
inline void expectEstimate(const Estimate& estimate, double truth, double largest, double floor = 1e-12) {
    EXPECT_LE(estimate.error.x, largest);
    EXPECT_NEAR(estimate.mean.x, truth, 5.0 * estimate.error.x + floor);
}

}  // namespace glint::oracle
