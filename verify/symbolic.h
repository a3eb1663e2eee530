// Executes a function of a SPIR-V module symbolically. The result is a program that computes its outputs for
// all inputs.
#pragma once

#include "verify/program.h"

#include <glint/result.h>

#include <cstdint>
#include <span>
#include <string>

namespace glint::verify {

// Executes `void name(float i[N], inout float o[M])`, whose parameters are the program's inputs and outputs.
// All branches are taken, each under its condition; loops are unrolled until their condition is false. A
// branch's condition, such as x < y, bounds x and y within the branch.
//
// The words are valid SPIR-V that keeps names. Errors: "spirv-format"; "prove-unsupported" where the function
// has operations that intervals can't follow: resources, loops without a known end.
Result<Program> executeSymbolically(std::span<const std::uint32_t> words, const std::string& name);

}  // namespace glint::verify
