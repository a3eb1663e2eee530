// Reads the measurements that `glint bench --calibrate` wrote to calibration.json, for another fit.
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

// Reads the format of docs/schemas/calibration.json, without strategies that were skipped or drew another
// picture. `machine` may have a `subgroupSize`; its default is 8 for a CPU and 32 for a GPU. Errors
// "file-open", "file-read", "calibration-format".
Result<CalibrationPoints> readCalibrationPoints(const std::filesystem::path& path);

}  // namespace glint
