// Options that the table of settings declares (settings/table.h), and options that belong to them.
#pragma once

#include "base/memo.h"
#include "gltf/import.h"
#include "settings/table.h"

#include <CLI/CLI.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace glint::cli {

// Adds an option for each setting of a command. `settings` has the defaults, and must outlive the command.
void addSettings(CLI::App& command, compiler::SettingCommand which, compiler::Settings& settings);

// Takes what the options of settings mean together. Throws a CLI::ParseError if some contradict each other.
void settleSettings(const CLI::App& command, compiler::Settings& settings);
// Throws a CLI::ParseError if the merge policy and the profile contradict each other.
void checkProfile(const CLI::App& command, const compiler::Settings& settings);

// Adds --profile FILE, for commands that read profiles.
void addProfileInput(CLI::App& command, compiler::Settings& settings);
// Adds --calibration: the device file by which --strategy auto chooses.
void addCalibration(CLI::App& command, compiler::Settings& settings);
// Adds --scene NAME|INDEX, --variant NAME, --strict-paths and --materials DIR.
void addReadingOptions(CLI::App& command, compiler::Settings& settings);

// Returns the warning "setting-idle": `words` of the command line change nothing, for a reason.
Diagnostic idleWarning(const std::string& where, const std::string& words, const std::string& reason);
// Returns a warning for each setting that was given and changes nothing: for a picture with `settings`, or
// for a package of the scenes. `plan` is what it is planned with.
std::vector<Diagnostic> idleSettings(std::span<const gltf::Scene> scenes, compiler::SettingCommand which,
                                     const compiler::Settings& settings, compiler::PlanOptions plan);

// What a command needs of images.
enum class ImageReading : std::uint8_t {
    None,
    Files,  // for scene_view::loadTextures()
};

// For commands that compile shaders.
void addHostOption(CLI::App& command, compiler::Settings& settings);
// Returns how a scene is read. `texels` keeps what was found in images; null: nothing is kept. Has the errors
// of loadMaterialModel().
Result<gltf::ImportOptions> importOptions(const compiler::Settings& settings, ImageReading images,
                                          base::Memo* texels);

}  // namespace glint::cli
