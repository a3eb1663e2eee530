// What `glint explain` says of strategies: what each is expected to take, of what, and which to choose.
#pragma once

#include "plan/strategy_choice.h"

#include <string>

namespace glint {

// A table of milliseconds, the recommended strategy and why.
std::string strategiesText(const StrategyAdvice& advice);

}  // namespace glint
