// glint bench --calibrate: which strategy is fastest on this device, measured on generated scenes.
#pragma once

#include "cli/bench_arguments.h"
#include "cli/console.h"

namespace glint {

inline constexpr const char* kCalibrationFile = "calibration.json";

// Measures and writes; returns the exit code.
int calibrate(const Console& console, const BenchArguments& arguments);

}  // namespace glint
