// Declares the options of subcommands: choices, ranges and defaults are checked and documented in one place.
#pragma once

#include "cli/console.h"
#include "gltf/import.h"

#include <glint/measure/render_settings.h>

#include <CLI/CLI.hpp>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace glint {

// The work of a subcommand once its command line is parsed. Returns the exit code.
using Action = std::function<int(const Console&)>;

// Adds a subcommand with an example at the end of its help.
CLI::App& addCommand(CLI::App& app, const std::string& name, const std::string& what,
                     const std::string& example);

// Adds an option that takes one of `choices`; the text in `value`, if any, is the default. A misspelt value
// suggests the nearest choice.
CLI::Option& addChoice(CLI::App& command, const std::string& flags, std::string& value,
                       const std::vector<std::string>& choices, const std::string& help);
// Adds an option that takes any of `choices`, separated by commas.
CLI::Option& addChoices(CLI::App& command, const std::string& flags, std::vector<std::string>& values,
                        const std::vector<std::string>& choices, const std::string& help);
// Returns the choices that addChoice() and addChoices() were given; empty for other options.
std::vector<std::string> choicesOf(CLI::Option& option);
// Adds an option for a whole number within [min, max]; `value` is the default.
CLI::Option& addInteger(CLI::App& command, const std::string& flags, std::int64_t& value, std::int64_t min,
                        std::int64_t max, const std::string& help);
// Adds an option for a number within [min, max].
CLI::Option& addReal(CLI::App& command, const std::string& flags, double& value, double min, double max,
                     const std::string& help);
// Adds an option for a path or a name: any text except an empty one.
CLI::Option& addText(CLI::App& command, const std::string& flags, std::string& value, const std::string& type,
                     const std::string& help);
// Adds an option for one or more texts.
CLI::Option& addTexts(CLI::App& command, const std::string& flags, std::vector<std::string>& values,
                      const std::string& type, const std::string& help);
// Adds an option for an image to write. Its extension must be one of `extensions`.
CLI::Option& addImageOutput(CLI::App& command, const std::string& flags, std::string& value,
                            const std::vector<std::string>& extensions, const std::string& help);
CLI::Option& addFlag(CLI::App& command, const std::string& flags, bool& value, const std::string& help);

// Appends a parsed option as it would be given again, with one word for each value.
void addWords(const CLI::Option& option, std::vector<std::string>& words);

// Options that decide which permutations a scene has and which share code. Every command that plans has the
// same ones.
// Returns the options, for commands that must know which of them are given.
std::vector<CLI::Option*> addPlanOptions(CLI::App& command, measure::PlanSettings& arguments);
// Adds --profile FILE, for commands that read profiles.
void addProfileInput(CLI::App& command, measure::PlanSettings& arguments);
// Takes FILE out of `--merge profile:FILE` and `auto:FILE`. Throws a CLI::ParseError if the policy and the
// profile contradict each other.
void settleProfile(measure::PlanSettings& arguments);

// Options that decide how exact shaders are. Every command that compiles has the same ones.
std::vector<CLI::Option*> addAccuracyOptions(CLI::App& command, measure::AccuracySettings& arguments);

// --variant NAME, --strict-paths.
void addReadingOptions(CLI::App& command, measure::ReadingSettings& arguments);
// Has the errors of loadMaterialModel().
Result<ImportOptions> importOptions(const measure::ReadingSettings& arguments, bool decodeImages);

}  // namespace glint
