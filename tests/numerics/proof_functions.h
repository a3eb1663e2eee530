// The functions of proofs_*.glsl as C++, but for those that macros there make.
#pragma once

#include "evaluate.h"

namespace glint::numerics {

std::span<const ProbeFunction<float>> floatProofs();
std::span<const ProbeFunction<double>> doubleProofs();

}  // namespace glint::numerics
