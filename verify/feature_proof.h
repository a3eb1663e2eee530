// The claim of `glint check-materials --prove`: the code of a feature as a function of its parameters,
// texels, view and light, and the ranges of its results.
#pragma once

#include "emit/compile.h"
#include "gltf/scene.h"
#include "verify/prover.h"

#include <glint/result.h>

namespace glint::verify {

struct FeatureProof {
    Program program;
    Claim claim;
};

// `code` is of the plan's model, and the plan is of a scene that has the feature. Errors are those of
// compileShader() and executeSymbolically(): "prove-unsupported" where the code reads what the proof has no
// bounds of.
Result<FeatureProof> compileFeatureProof(const gltf::Scene& scene, const compiler::Plan& plan,
                                         const compiler::CompileSettings& settings,
                                         const materials::FeatureCode& code);

}  // namespace glint::verify
