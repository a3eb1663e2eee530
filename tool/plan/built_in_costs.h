// The devices whose costs Glint knows without a calibration.
#pragma once

#include "plan/strategy_cost.h"

namespace glint {

// Those of the device of that type that was measured (plan/strategy_constants.h); of the other type where
// there is none.
DeviceCosts builtInCosts(bool onCpu);

}  // namespace glint
