// The results of glint bench and of its calibration, for people.
#pragma once

#include <glint/measure/calibration.h>
#include <glint/measure/device_file.h>
#include <glint/measure/report.h>

#include <string>

namespace glint::cli {

std::string toText(const measure::BenchReport& report);
// Returns a table in Markdown.
std::string toText(const measure::CalibrationReport& report);
// Describes the constants, how far estimates are off, and the cost of choosing by them.
std::string describe(const measure::DeviceFile& file);

}  // namespace glint::cli
