// The GLSL of compute shaders around probes.
#pragma once

#include "probes.h"

#include <cstdint>
#include <string>
#include <string_view>

namespace glint::numerics {

inline constexpr std::uint32_t kProbeGroup = 64;

// In how many bits a probe is computed on the device.
enum class ProbePrecision : std::uint8_t {
    Single,  // all in 32
    Mixed,   // as --precision 16 does
    Half     // all in 16
};

// Flattened, for make_probes wrote it into the program.
std::string_view probeText();

// One thread applies the probe to one element of the inputs.
std::string probeKernel(std::string_view probe, int inputs, int outputs, ProbePrecision precision);

// One thread applies the probe to its element again and again. Each input is multiplied by a number of a
// buffer that is 1, so that no evaluation can be left out for being the same as the last.
//
// With an empty name what the function costs is missing, and nothing else: the products, and a sum over the
// inputs.
std::string timedKernel(std::string_view probe, int inputs, int outputs, ProbePrecision precision);

}  // namespace glint::numerics
