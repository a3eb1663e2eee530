// The output of `glint explain` about strategies: the expected time of each, its parts, and which one to
// choose.
#pragma once

#include "plan/strategy_choice.h"

#include <string>

namespace glint {

// Returns a table of milliseconds, the recommended strategy and the reason.
std::string strategiesText(const StrategyAdvice& advice);

}  // namespace glint
