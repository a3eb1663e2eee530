// Options that decide how rays are traced and shaded: those that a package is compiled with, and those that a
// renderer chooses at run time.
#pragma once

#include "cli/options/options.h"

#include <string>
#include <vector>

namespace glint {

// Adds --strategy and --tracer as lists, --shadows, --hit-record, --position-fetch.
void addTracingLists(CLI::App& command, measure::TracingSettings& arguments);
// Adds --strategy and --tracer with one value, --shadows, --hit-record, --position-fetch. Returns the options
// that a package decides: all but the first.
std::vector<CLI::Option*> addTracingChoice(CLI::App& command, measure::TracingSettings& arguments);

// Adds --calibration: the device file by which --strategy auto chooses. `file` is empty if it is not given.
void addCalibration(CLI::App& command, std::string& file);

// Throws a CLI::ParseError if the tracer can't run the strategy.
void checkTracingChoice(const measure::TracingSettings& arguments);

// The settings that a renderer chooses.
void addFrameOptions(CLI::App& command, measure::FrameSettings& arguments);

}  // namespace glint
