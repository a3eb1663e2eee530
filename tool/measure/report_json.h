// The reports as JSON: docs/schemas/bench.json and docs/schemas/calibration.json.
#pragma once

#include "base/json.h"

#include <glint/measure/calibration.h>
#include <glint/measure/report.h>

namespace glint::measure {

Json toJson(const BenchMachine& machine);
// Numbers that are not finite become null.
Json toJson(const Interval& interval);
Json toJson(const BenchReport& report);
Json toJson(const CalibrationReport& report);

}  // namespace glint::measure
