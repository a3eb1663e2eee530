// The reports as JSON: docs/schemas/bench.json and docs/schemas/calibration.json.
#pragma once

#include "base/json.h"

#include <glint/measure/calibration_report.h>
#include <glint/measure/report.h>

namespace glint::measure {

base::Json toJson(const BenchMachine& machine);
// Numbers that are not finite become null.
base::Json toJson(const Interval& interval);
base::Json toJson(const BenchReport& report);
base::Json toJson(const CalibrationReport& report);
base::Json toJson(const CalibrationEntry& entry);  // one of its points

}  // namespace glint::measure
