// What `glint check-materials --prove` proves: the code of a feature as a function of its parameters, texels,
// view and light, and the ranges of its results.
#pragma once

#include "emit/compile.h"
#include "prove/prover.h"

#include <glint/result.h>

namespace glint::compiler {

struct FeatureProof {
    prove::Program program;
    prove::Claim claim;
};

// `code` is of the plan's model, and the build is of a scene that has the feature. Errors are those of
// compileShader() and executeSymbolically(): "prove-unsupported" where the code reads what the proof has no
// bounds of.
Result<FeatureProof> compileFeatureProof(const Build& build, const materials::FeatureCode& code);

}  // namespace glint::compiler
