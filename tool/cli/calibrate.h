// glint bench --calibrate: measures on generated scenes which strategy is fastest on this device.
#pragma once

#include "cli/bench_arguments.h"
#include "cli/console.h"

namespace glint {

inline constexpr const char* kCalibrationFile = "calibration.json";

// Measures and writes the results. Returns the exit code.
int calibrate(const Console& console, const BenchArguments& arguments);

}  // namespace glint
