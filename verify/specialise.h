// What is left of a program over a domain: without the branches that no input of it takes, and with one value
// where a choice always chooses the same. Patterns (program_patterns.cpp) that a choice hid are found then.
#pragma once

#include "verify/program.h"

#include <span>

namespace glint::verify {

// `domain` has an interval for each input. The outputs have the same numbers and, over the domain, the same
// values.
Program specialise(const Program& program, std::span<const Interval> domain);

}  // namespace glint::verify
