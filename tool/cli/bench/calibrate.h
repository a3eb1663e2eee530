// glint bench --calibrate: measures on generated scenes which strategy is fastest on this device.
#pragma once

#include "cli/bench/arguments.h"
#include "cli/console.h"

namespace glint::cli {

// Measures and writes the results. Returns the exit code.
int calibrate(const Console& console, const BenchArguments& arguments);

}  // namespace glint::cli
