// Made by benchmarks/fit_merge_model.py from benchmarks/data/merge_model.csv; run it again rather than edit
// this.
//
// Fitted to 200 shaders of one key and 37 that branch, less a quarter of the random ones. On that quarter
// the model is off, in instructions, and in texture fetches:
//
//                shaders  mean error  largest      R2  fetches, most
//     one key         29        7.2 %     44.1 %   0.881           0.0
//     branches        10        5.4 %     10.7 %   0.961           0.0
//
// The mean and the largest error are relative; R2 is that of the instructions.
#pragma once

namespace glint::compiler::fitted {

// SPIR-V instructions of the shader of one unlit key without other features, and what being lit adds.
inline constexpr double kUnlitInstructions = 98.0;
inline constexpr double kLitInstructions = 817.0;

// Instructions beyond the features' own code, for each feature that a shader branches on.
inline constexpr double kInputBranch = 26.0;
inline constexpr double kLobeBranch = 252.0;

// The code of a feature itself is in its declaration ("cost").

}  // namespace glint::compiler::fitted
