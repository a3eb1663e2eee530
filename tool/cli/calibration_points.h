// The measurements that `glint bench --calibrate` leaves in calibration.json, read again for another fit.
#pragma once

#include "bench/calibration_point.h"
#include "plan/strategy_cost.h"

#include <glint/result.h>

#include <filesystem>
#include <vector>

namespace glint {

struct CalibrationPoints {
    DeviceCosts device;  // without strategies
    std::vector<bench::CalibrationPoint> points;
};

// Reads `machine` (device, driver, deviceType, tracers, subgroupSize), `command` and `points`, whose members
// are those of the structures; `subgroupSize` may be left out, and is 8 of a CPU then, else 32. Errors
// "file-open", "file-read", "calibration-format".
Result<CalibrationPoints> readCalibrationPoints(const std::filesystem::path& path);

}  // namespace glint
