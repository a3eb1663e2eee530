// The shaders' functions in double precision, in namespace glsl. Energy compensation is a variable here; a
// test that changes it must set it back.
#pragma once

namespace glsl {
inline thread_local int energyCompensation = 1;
}  // namespace glsl

#define GLINT_REAL double
#include "numerics/glsl.h"

#define GLINT_ENERGY_COMPENSATION energyCompensation
#define PROBE(name) [[maybe_unused]] void probe##name(const Real* i, Real* o)
namespace glsl {
namespace {
#include "probes.inc"
}  // namespace
}  // namespace glsl
