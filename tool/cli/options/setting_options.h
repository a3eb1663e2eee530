// Options that the table of settings declares (settings/descriptor.h), and options that belong to them.
#pragma once

#include "resolve/resolve.h"
#include "settings/descriptor.h"

#include <glint/result.h>

#include <CLI/CLI.hpp>

#include <optional>
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

// --- The option --settings: a file of settings, as glint bench writes it, completes a command line ---

// Adds --settings FILE, for commands that have some of settingNames() as options.
void addSettingsFile(CLI::App& command, std::string& file);

// A command line, with the options that come from a file.
struct CompletedLine {
    std::vector<std::string> words;
    std::string file;                  // empty: it names none
    std::vector<std::string> options;  // "--spp": those that the file gave
};

// Returns `arguments`, which lack the program's name, plus the settings from the file of --settings that they
// do not give. Options that the command does not have are left out, and with --package those that the package
// has decided. Has the errors of readSettings().
Result<CompletedLine> completeLine(const CLI::App& app, std::span<const char* const> arguments);

// Returns the error "settings-file" if a complaint of CLI11 is about an option that came from the file.
std::optional<Diagnostic> blameFile(const CompletedLine& line, const std::string& complaint);

}  // namespace glint::cli
