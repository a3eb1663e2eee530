// Specialises a program for a domain: removes the branches that no input of the domain takes, and replaces
// choices that always choose the same side. Then finds the patterns (program_patterns.cpp) that a choice hid.
#pragma once

#include "verify/program.h"

#include <span>

namespace glint::verify {

// `domain` has an interval for each input. The outputs have the same numbers and, over the domain, the same
// values.
Program specialise(const Program& program, std::span<const Interval> domain);

}  // namespace glint::verify
