// The device file: what `glint bench --calibrate` has found of a device, and `--calibration` reads.
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

// Fits the constants of a device to what was measured on it. `device`: everything of it but its strategies.
// Notes "calibration-points" of what was left out; an error of that id where no strategy could be fitted.
Result<DeviceFile> fitDevice(DeviceCosts device, std::span<const bench::CalibrationPoint> points,
                             std::vector<Diagnostic>& notes);

// For people: the constants, how far estimates are off, and what a choice by them costs.
std::string describe(const DeviceFile& file);

// JSON as docs/schemas/device.json has it.
std::string toText(const DeviceFile& file);

// Errors "file-open", "file-read", "calibration-format".
Result<DeviceFile> readDeviceFile(const std::filesystem::path& path);

}  // namespace glint
