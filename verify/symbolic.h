// Executes a function of a SPIR-V module symbolically: what it computes, for whatever inputs, becomes a
// program.
#pragma once

#include "verify/program.h"

#include <glint/result.h>

#include <cstdint>
#include <span>
#include <string>

namespace glint::verify {

// Executes `void name(float i[N], inout float o[M])`, whose parameters are the program's inputs and outputs.
// All branches are taken, each under its condition; loops are unrolled until their condition is false. What a
// branch knows, that x < y say, holds for x and y within it.
//
// The words are valid SPIR-V that keeps names. Errors: "spirv-format"; "prove-unsupported" where the function
// does what intervals can't follow: resources, loops without a known end.
Result<Program> executeSymbolically(std::span<const std::uint32_t> words, const std::string& name);

}  // namespace glint::verify
