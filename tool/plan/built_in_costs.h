// The constants of the cost model that Glint has built in, for devices without a calibration.
#pragma once

#include "plan/strategy_cost.h"

namespace glint::compiler {

// Returns the constants of the measured device of that type (plan/strategy_constants.h). If no device of that
// type was measured, it returns those of the other type.
DeviceCosts builtInCosts(bool onCpu);

}  // namespace glint::compiler
