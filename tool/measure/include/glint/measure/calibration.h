// Measures on generated scenes which strategy is fastest on a device: `glint bench --calibrate` without a
// command line.
#pragma once

#include "settings/settings.h"

#include <glint/context.h>
#include <glint/measure/device_file.h>
#include <glint/measure/observer.h>
#include <glint/result.h>

#include <filesystem>
#include <memory>
#include <optional>

namespace glint::compiler {
class ModuleCache;
}  // namespace glint::compiler

namespace glint::measure {

inline constexpr const char* kCalibrationFile = "calibration.json";
inline constexpr const char* kDeviceFile = "device.json";

// Opens the device that `render` names, without a window. Has the errors of Context::createHeadless().
Result<std::unique_ptr<Context>> openCalibrationDevice(const compiler::Settings& render);

// Compiles all scenes, and then measures them one after another. Writes calibration.json after each group of
// scenes, so that an interrupted run keeps its measurements. The caller has set command, date, machine,
// rounds, seed and quick of `report`. `cache` may be null. Warns "calibrate-point" of strategies that did not
// run and "calibrate-picture" of pictures that are wrong. Errors: of the device, of compiling,
// "bench-folder", "file-write", "validation".
Status runCalibration(const Observer& observer, const CalibrationSettings& settings, Context& context,
                      compiler::ModuleCache* cache, CalibrationReport& report);

// Fits the constants of the device to the calibration.json in `folder`, as scripts do with other
// measurements, and writes device.json beside it. Too few measurements are a note, and the result is empty.
// Errors of readFile() and writeFile(), "calibration-format".
Result<std::optional<DeviceFile>> fitCalibration(const Observer& observer,
                                                 const std::filesystem::path& folder);

}  // namespace glint::measure
