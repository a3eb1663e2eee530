// The device file: `glint bench --calibrate` writes it, and `--calibration` reads it.
#pragma once

#include "bench/strategy_fit.h"
#include "plan/strategy_cost.h"

#include <glint/result.h>

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace glint {

struct DeviceFile {
    DeviceCosts costs;
    bench::FitQuality quality;
};

// Fits the constants of a device to measurements on it. `device` holds everything except its strategies. Adds
// notes "calibration-points" about points that were left out. Returns an error with that id if no strategy
// could be fitted.
Result<DeviceFile> fitDevice(DeviceCosts device, std::span<const bench::CalibrationPoint> points,
                             std::vector<Diagnostic>& notes);

// Describes for people the constants, how far estimates are off, and the cost of choosing by them.
std::string describe(const DeviceFile& file);

// Returns JSON in the format of docs/schemas/device.json.
std::string toText(const DeviceFile& file);

// Errors "file-open", "file-read", "calibration-format".
Result<DeviceFile> readDeviceFile(const std::filesystem::path& path);

}  // namespace glint
