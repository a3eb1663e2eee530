// Options that the table of settings declares (settings/table.h), and options that belong to them.
#pragma once

#include "gltf/import.h"
#include "settings/table.h"

#include <CLI/CLI.hpp>

#include <string>

namespace glint {

// Adds an option for each setting of a command. `settings` has the defaults, and must outlive the command.
void addSettings(CLI::App& command, SettingCommand which, Settings& settings);

// Takes what the options of settings mean together. Throws a CLI::ParseError if some contradict each other.
void settleSettings(const CLI::App& command, const Settings& settings);
// Throws a CLI::ParseError if the merge policy and the profile contradict each other.
void checkProfile(const CLI::App& command, const Settings& settings);

// Adds --profile FILE, for commands that read profiles.
void addProfileInput(CLI::App& command, Settings& settings);
// Adds --calibration: the device file by which --strategy auto chooses.
void addCalibration(CLI::App& command, Settings& settings);
// Adds --variant NAME, --strict-paths and --materials DIR.
void addReadingOptions(CLI::App& command, Settings& settings);

// For commands that compile shaders.
void addHostOption(CLI::App& command, Settings& settings);
// Returns how a scene is read. Has the errors of loadMaterialModel().
Result<ImportOptions> importOptions(const Settings& settings, bool decodeImages);

}  // namespace glint
