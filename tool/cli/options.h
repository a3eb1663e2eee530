// How every subcommand declares its options: choices, ranges and defaults are checked and stated in one
// place.
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

// What a subcommand does once its command line is parsed; returns the exit code.
using Action = std::function<int(const Console&)>;

// A subcommand with an example at the end of its help.
CLI::App& addCommand(CLI::App& app, const std::string& name, const std::string& what,
                     const std::string& example);

// One of `choices`; the text in `value`, if any, is the default. A misspelt value suggests the nearest.
CLI::Option& addChoice(CLI::App& command, const std::string& flags, std::string& value,
                       const std::vector<std::string>& choices, const std::string& help);
// Any of `choices`, separated by commas.
CLI::Option& addChoices(CLI::App& command, const std::string& flags, std::vector<std::string>& values,
                        const std::vector<std::string>& choices, const std::string& help);
// What addChoice() and addChoices() were given; empty for other options.
std::vector<std::string> choicesOf(CLI::Option& option);
// A whole number within [min, max]; `value` is the default.
CLI::Option& addInteger(CLI::App& command, const std::string& flags, std::int64_t& value, std::int64_t min,
                        std::int64_t max, const std::string& help);
// A number within [min, max].
CLI::Option& addReal(CLI::App& command, const std::string& flags, double& value, double min, double max,
                     const std::string& help);
// A path or a name: any text but the empty one.
CLI::Option& addText(CLI::App& command, const std::string& flags, std::string& value, const std::string& type,
                     const std::string& help);
// One or more.
CLI::Option& addTexts(CLI::App& command, const std::string& flags, std::vector<std::string>& values,
                      const std::string& type, const std::string& help);
// An image to write: error unless its extension is one of `extensions`.
CLI::Option& addImageOutput(CLI::App& command, const std::string& flags, std::string& value,
                            const std::vector<std::string>& extensions, const std::string& help);
CLI::Option& addFlag(CLI::App& command, const std::string& flags, bool& value, const std::string& help);

// Which permutations a scene has, and which share code: the same options for every command that plans.
struct PlanArguments {
    std::string merge = "family";
    std::string alpha = "opaque";
    std::vector<std::string> hitLobes{"all"};
    std::int64_t maxShaders = 0;
    std::string profile;  // file of hit counts, for --merge profile and auto
    // Everything but the hits of a profile, which choosePlan() reads.
    PlanOptions options() const;
};
// Returns the options, for commands that must know which are given.
std::vector<CLI::Option*> addPlanOptions(CLI::App& command, PlanArguments& arguments);
// --profile FILE, for commands that read profiles.
void addProfileInput(CLI::App& command, PlanArguments& arguments);
// Takes FILE out of `--merge profile:FILE` and `auto:FILE`. Throws a CLI::ParseError where the policy and the
// profile disagree.
void settleProfile(PlanArguments& arguments);

// How exact shaders are: the same options for every command that compiles.
struct AccuracyArguments {
    std::string energyCompensation = "on";
    std::string textureLod = "cones";
    std::string precision = "32";
    // Whether shaders compute in 16-bit float, too.
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

// A number within [min, max], the whole of `text`; NaN is outside of every range.
bool parseReal(const std::string& text, double min, double max, double& value);

}  // namespace glint
