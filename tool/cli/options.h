// Declares the options of subcommands: choices, ranges and defaults are checked and documented in one place.
#pragma once

#include "cli/console.h"
#include "emit/compile.h"
#include "plan/plan.h"

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

// Options that decide which permutations a scene has and which share code. Every command that plans has the
// same ones.
struct PlanArguments {
    std::string merge = "family";
    std::string alpha = "auto";
    std::vector<std::string> hitLobes{"all"};
    std::int64_t maxShaders = 0;
    std::string profile;  // file of hit counts, for --merge profile and auto
    // Returns everything except what choosePlan() finds out: the hits of a profile, and the alpha policy if
    // it is `auto`.
    PlanOptions options() const;
};
// Returns the options, for commands that must know which of them are given.
std::vector<CLI::Option*> addPlanOptions(CLI::App& command, PlanArguments& arguments);
// Adds --profile FILE, for commands that read profiles.
void addProfileInput(CLI::App& command, PlanArguments& arguments);
// Takes FILE out of `--merge profile:FILE` and `auto:FILE`. Throws a CLI::ParseError if the policy and the
// profile contradict each other.
void settleProfile(PlanArguments& arguments);

// Options that decide how exact shaders are. Every command that compiles has the same ones.
struct AccuracyArguments {
    std::string energyCompensation = "on";
    std::string textureLod = "cones";
    std::string precision = "32";
    // Returns whether shaders also compute in 16-bit float.
    bool halves() const {
        return precision == "16";
    }
    void apply(CompileSettings& settings) const;
};
std::vector<CLI::Option*> addAccuracyOptions(CLI::App& command, AccuracyArguments& arguments);

// How scenes are read.
struct ReadingArguments {
    std::string variant;  // of KHR_materials_variants; empty: none
    bool strictPaths = false;
};
// --variant NAME, --strict-paths.
void addReadingOptions(CLI::App& command, ReadingArguments& arguments);

// Parses the whole of `text` as a number within [min, max]. NaN is outside of every range.
bool parseReal(const std::string& text, double min, double max, double& value);

}  // namespace glint
