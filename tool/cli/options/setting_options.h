// Options that the table of settings declares (settings/table.h), and options that belong to them.
#pragma once

#include "resolve/resolve.h"
#include "settings/table.h"

#include <CLI/CLI.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace glint::cli {

// Adds an option for each setting of a command. `settings` has the defaults, and must outlive the command.
void addSettings(CLI::App& command, compiler::SettingCommand which, compiler::Settings& settings);

// Throws a CLI::ParseError if some options of settings contradict each other.
void checkSettings(const CLI::App& command, const compiler::Settings& settings);
// Throws a CLI::ParseError if the merge policy and the profile contradict each other.
void checkProfile(const CLI::App& command, const compiler::Settings& settings);

// Adds --profile FILE, for commands that read profiles.
void addProfileInput(CLI::App& command, compiler::Settings& settings);
// Adds --calibration: the device file by which --strategy auto chooses.
void addCalibration(CLI::App& command, compiler::Settings& settings);
// Adds --lock FILE; for commands that write the file also --locked and --lock-prune.
void addLockOptions(CLI::App& command, compiler::LockRequest& request, bool isWritten);
// Adds --scene NAME|INDEX, --variant NAME, --strict-paths and --materials DIR.
void addReadingOptions(CLI::App& command, compiler::Settings& settings);

// Returns the warning "setting-idle": `words` of the command line change nothing, for a reason.
Diagnostic idleWarning(const std::string& where, const std::string& words, const std::string& reason);
// Returns a warning for each setting that was given and changes nothing in a build's pictures or package.
std::vector<Diagnostic> idleSettings(const compiler::Build& build);

// For commands that compile shaders.
void addHostOption(CLI::App& command, compiler::Settings& settings);

}  // namespace glint::cli
