// How far Glint's pictures may be from the specification, and why where that is more than a few percent.
#pragma once

#include "oracle/spec/comparison.h"

#include <string>

namespace glint::spec {

// How far the device may be from the specification with the approximations that Glint states, relative to
// that, besides the noise of its samples.
struct Bound {
    double relative = 0.0;
    const char* why = "";
};
Bound boundOf(const Comparison& comparison);

// Returns why a comparison fails its bound, or nothing. The device may be off from the specification with the
// approximations that Glint states, by 2 % and the noise of its samples; a white material in a white furnace
// by 1 % from 1, in every zone.
std::string objectionTo(const Comparison& comparison);

}  // namespace glint::spec
