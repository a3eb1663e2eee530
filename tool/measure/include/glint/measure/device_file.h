// The files of `glint bench --calibrate`: calibration.json with the measurements, and device.json with the
// constants fitted to them, by which `--strategy auto` chooses.
#pragma once

#include "plan/strategy_cost.h"

#include <glint/measure/strategy_fit.h>
#include <glint/result.h>

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace glint::measure {

struct DeviceFile {
    compiler::DeviceCosts costs;
    FitQuality quality;
};

// Fits the constants of a device to measurements on it. `device` holds everything except its strategies. Adds
// notes "calibration-points" about points that were left out. Returns an error with that id if no strategy
// could be fitted.
Result<DeviceFile> fitDevice(compiler::DeviceCosts device, std::span<const CalibrationPoint> points,
                             std::vector<Diagnostic>& notes);

// Returns JSON in the format of docs/schemas/device.json.
std::string toText(const DeviceFile& file);

// Errors "file-open", "file-read", "calibration-format".
Result<DeviceFile> readDeviceFile(const std::filesystem::path& path);

struct CalibrationPoints {
    compiler::DeviceCosts device;  // without strategies
    std::vector<CalibrationPoint> points;
};

// Reads the format of docs/schemas/calibration.json, without strategies that were skipped or drew another
// picture. `machine` may have a `subgroupSize`; its default is 8 for a CPU and 32 for a GPU. Errors
// "file-open", "file-read", "calibration-format".
Result<CalibrationPoints> readCalibrationPoints(const std::filesystem::path& path);

}  // namespace glint::measure
