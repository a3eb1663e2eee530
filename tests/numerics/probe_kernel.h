// The GLSL of compute shaders around probes.
#pragma once

#include "probes.h"

#include <cstdint>
#include <string>
#include <string_view>

namespace glint::numerics {

inline constexpr std::uint32_t kProbeGroup = 64;

// The number of bits in which the device computes a probe.
enum class ProbePrecision : std::uint8_t {
    Single,  // all in 32
    Mixed,   // as --precision 16 does
    Half     // all in 16
};

// Returns the flattened text, which make_probes wrote into the program.
std::string_view probeText();

// Returns a kernel in which one thread applies the probe to one element of the inputs.
std::string probeKernel(std::string_view probe, int inputs, int outputs, ProbePrecision precision);

// Returns a kernel in which one thread applies the probe to its element again and again. Each input is
// multiplied by a number of a buffer that is 1, so that no evaluation can be left out because it equals the
// last.
//
// With an empty name only the function is missing; the products and a sum over the inputs remain.
std::string timedKernel(std::string_view probe, int inputs, int outputs, ProbePrecision precision);

}  // namespace glint::numerics
