// The functions of proofs_*.glsl as C++, but for those that macros there make.
#pragma once

#include "evaluate.h"

namespace glint::numerics {

// For float and double; proof_functions.cpp is compiled for each.
template <typename Real>
std::span<const ProbeFunction<Real>> proofFunctions();
template <>
std::span<const ProbeFunction<float>> proofFunctions<float>();
template <>
std::span<const ProbeFunction<double>> proofFunctions<double>();

}  // namespace glint::numerics
