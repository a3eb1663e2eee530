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

// Reads what docs/schemas/calibration.json describes, without strategies that were skipped or drew another
// picture. `machine` may have a `subgroupSize`, which else is 8 of a CPU and 32 of a GPU. Errors "file-open",
// "file-read", "calibration-format".
Result<CalibrationPoints> readCalibrationPoints(const std::filesystem::path& path);

}  // namespace glint
